// SPDX-License-Identifier: Apache-2.0
// Matches the writers and readers of one process by topic and hands samples from one to the other.
// Knows no message types. Internal to common/link: local_network.h makes hubs of it.
//
//   Put:      the writer's history (late_joiners) and the queue of each matched reader get the
//             sample; the reader's receiver learns that the reader is ready
//   receiver: a thread that takes the oldest sample of a ready reader and calls the reader back
//
// A reader's queue holds the last n per writer and key, or all, where the writer's bound of unread
// bytes limits it. A receiver calls its ready readers in turn, one sample each: a busy topic does
// not shut out the others.
//
// One mutex guards everything here, and the samples' counts; no callback runs and no payload is
// copied or freed while it is held.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/base/mutex.h"
#include "common/link/sample_queue.h"
#include "common/link/stored_sample.h"
#include "common/link/topic.h"

namespace shoal::link {

class LocalExchange {
 public:
  class Writer;
  class Reader;
  class Receiver;
  // Chooses one of `count` ready readers, as a number below it.
  using Choice = std::function<size_t(size_t count)>;

  // Without a choice a receiver calls its ready readers in turn.
  explicit LocalExchange(Choice choose = nullptr) : choose_(std::move(choose)) {}

  // The exchange's part of a writer. It and its samples know each other by `unread`.
  class Writer {
   public:
    // `hub`: whose it is, for Abandon.
    Writer(const void* hub, const TopicSettings& settings, uint64_t unread_bytes_bound)
        : hub_(hub),
          settings_(settings),
          bound_(unread_bytes_bound),
          unread_(std::make_shared<Unread>()),
          history_(settings.keep_last) {}

    const std::shared_ptr<Unread>& unread() const { return unread_; }

   private:
    friend class LocalExchange;
    const void* const hub_;
    const TopicSettings settings_;
    const uint64_t bound_;
    const std::shared_ptr<Unread> unread_;
    SampleQueue history_;  // with late_joiners
  };

  // The exchange's part of a reader, which calls `deliver` on the receiver's thread.
  class Reader {
   public:
    Reader(const void* hub, const TopicSettings& settings, Receiver& receiver,
           std::function<void(const StoredSample&)> deliver)
        : hub_(hub),
          settings_(settings),
          receiver_(receiver),
          deliver_(std::move(deliver)),
          queue_(settings.keep_last) {}

   private:
    friend class LocalExchange;
    const void* const hub_;
    const TopicSettings settings_;
    Receiver& receiver_;
    const std::function<void(const StoredSample&)> deliver_;
    SampleQueue queue_;
    bool called_ = false;  // `deliver` runs
    ConditionVariable returned_;
  };

  // The readers that a thread in ServeReaders calls back.
  class Receiver {
    friend class LocalExchange;
    std::deque<Reader*> ready_;  // those with samples, but for the one that is called; each once
    bool stopping_ = false;
    ConditionVariable changed_;
  };

  // Matches the end with those of the other side, until Remove. A reader first gets the history of
  // the topic's writers. Add and Remove are not for callbacks.
  void Add(Writer& writer);
  void Add(Reader& reader);
  // Samples of the writer that readers have not read yet still reach them.
  void Remove(Writer& writer);
  // Waits for a running callback; none starts afterwards.
  void Remove(Reader& reader);

  // Unmatches all ends of a hub. Its readers drop their samples; those of its writers still reach
  // other readers. Remove may follow.
  void Abandon(const void* hub);
  // Unmatches the ends of a hub until Reconnect, those that it makes meanwhile included. Its
  // readers drop their samples; its writers go on filling their histories.
  void Disconnect(const void* hub);
  // Matches the ends of a hub again, as new ones: a reader on either side gets the histories of the
  // writers on the other.
  void Reconnect(const void* hub);

  // Waits until the writer may have `bytes` more unread: at most max_blocking, then false. With
  // keep_last > 0 it does not wait. A sample above the bound has room when nothing is unread.
  bool WaitForRoom(Writer& writer, uint64_t bytes);
  // The sample is one of the writer's.
  void Put(Writer& writer, const SharedSample& sample);
  // Waits until all readers have finished reading the writer's samples. False at the deadline.
  bool WaitUntilRead(Writer& writer, SteadyTime deadline);

  // Matched ends of the other side.
  int Matched(const Writer& writer) const;
  int Matched(const Reader& reader) const;

  // Calls back the receiver's readers until Stop.
  void ServeReaders(Receiver& receiver);
  // The receiver's readers must be gone.
  void Stop(Receiver& receiver);

 private:
  struct Ends {
    std::vector<Writer*> writers;
    std::vector<Reader*> readers;
  };

  void Enqueue(Reader& reader, const SharedSample& sample, std::vector<SharedSample>* pushed_out)
      SHOAL_REQUIRES(mutex_);
  void EnqueueHistory(const Writer& writer, Reader& reader, std::vector<SharedSample>* pushed_out)
      SHOAL_REQUIRES(mutex_);
  // Moves the samples of the hub's readers to `dropped`.
  void DropUnread(const void* hub, std::list<SharedSample>* dropped) SHOAL_REQUIRES(mutex_);
  bool Connected(const void* hub) const SHOAL_REQUIRES(mutex_) {
    return !disconnected_.contains(hub);
  }
  template <class End>
  int CountConnected(const std::vector<End*>& ends) const SHOAL_REQUIRES(mutex_) {
    int count = 0;
    for (const End* end : ends) count += Connected(end->hub_) ? 1 : 0;
    return count;
  }
  // One of the sample's readers has finished with it.
  static void CountRead(StoredSample& sample);
  // The next reader to call, and its oldest sample; null when the receiver is stopped.
  Reader* WaitForReady(Receiver& receiver, SharedSample* sample) SHOAL_EXCLUDES(mutex_);
  void FinishCall(Reader& reader, StoredSample& sample) SHOAL_EXCLUDES(mutex_);

  const Choice choose_;
  mutable Mutex mutex_;
  std::map<std::string, Ends, std::less<>> topics_ SHOAL_GUARDED_BY(mutex_);
  std::set<const void*> disconnected_ SHOAL_GUARDED_BY(mutex_);  // hubs
};

}  // namespace shoal::link

// SPDX-License-Identifier: Apache-2.0
// Matches the writers and readers of one process by topic and passes samples from writers to
// readers. Does not depend on message types. Internal to common/link: local_network.h builds its
// hubs on this class.
//
//   Put        adds the sample to the writer's history (late_joiners) and to the queue of each
//              matched reader, and marks the reader as ready
//   receiver   a thread that takes the oldest sample of a ready reader and calls the reader back
//
// A reader's queue holds the last n samples per writer and key, or all samples, limited by the
// writer's bound of unread bytes. A receiver calls its ready readers in turn, one sample each, so
// that a busy topic does not starve the others.
//
// One mutex guards all members and the samples' counts. While a thread holds the mutex, no callback
// runs and no payload is copied or freed.
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
  // Chooses one of `count` ready readers: returns a number below `count`.
  using Choice = std::function<size_t(size_t count)>;

  // If `choose` is null, a receiver calls its ready readers in turn.
  explicit LocalExchange(Choice choose = nullptr) : choose_(std::move(choose)) {}

  // The exchange's data of a writer. The writer and its samples share `unread`.
  class Writer {
   public:
    // `hub`: the hub that owns the writer, for Abandon.
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
    SampleQueue history_;  // used with late_joiners only
  };

  // The exchange's data of a reader. The exchange calls `deliver` on the receiver's thread.
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
    bool called_ = false;  // `deliver` is running
    ConditionVariable returned_;
  };

  // The readers that a thread in ServeReaders calls back.
  class Receiver {
    friend class LocalExchange;
    // Readers that have samples, without duplicates and without the reader whose callback runs.
    std::deque<Reader*> ready_;
    bool stopping_ = false;
    ConditionVariable changed_;
  };

  // Matches a writer with the readers of its topic, or a reader with the writers, until Remove. A
  // reader first gets the history of the writers. Callbacks must not call Add or Remove.
  void Add(Writer& writer);
  void Add(Reader& reader);
  // Samples of the writer that are still unread are still delivered to the readers.
  void Remove(Writer& writer);
  // Waits until a running callback has returned. No callback starts afterwards.
  void Remove(Reader& reader);

  // Unmatches all writers and readers of a hub. The readers drop their samples. Samples of the
  // writers are still delivered to readers of other hubs. Remove may follow.
  void Abandon(const void* hub);
  // Unmatches the writers and readers of a hub until Reconnect, including those that the hub makes
  // before Reconnect. The readers drop their samples; the writers continue to fill their histories.
  void Disconnect(const void* hub);
  // Matches the writers and readers of a hub again, as if they were new. The hub's readers get the
  // histories of other hubs' writers, and readers of other hubs get the histories of this hub's
  // writers.
  void Reconnect(const void* hub);

  // Waits until the writer may have `bytes` more unread bytes. Returns false after max_blocking. If
  // keep_last > 0, returns true at once. A sample that is larger than the bound is allowed if
  // nothing is unread.
  bool WaitForRoom(Writer& writer, uint64_t bytes);
  // Passes a sample to the readers. It must be a sample of `writer`.
  void Put(Writer& writer, const SharedSample& sample);
  // Waits until all readers have finished reading the writer's samples. Returns false at the
  // deadline.
  bool WaitUntilRead(Writer& writer, SteadyTime deadline);

  // Number of readers that match the writer, or of writers that match the reader.
  int Matched(const Writer& writer) const;
  int Matched(const Reader& reader) const;

  // Calls back the receiver's readers until Stop.
  void ServeReaders(Receiver& receiver);
  // Ends ServeReaders. The receiver's readers must be removed before.
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
  // Records that one of the sample's readers has finished reading.
  static void CountRead(StoredSample& sample);
  // Waits for the next ready reader and returns it; `sample` becomes the reader's oldest sample.
  // Returns null if the receiver is stopped.
  Reader* WaitForReady(Receiver& receiver, SharedSample* sample) SHOAL_EXCLUDES(mutex_);
  void FinishCall(Reader& reader, StoredSample& sample) SHOAL_EXCLUDES(mutex_);

  const Choice choose_;
  mutable Mutex mutex_;
  std::map<std::string, Ends, std::less<>> topics_ SHOAL_GUARDED_BY(mutex_);
  std::set<const void*> disconnected_ SHOAL_GUARDED_BY(mutex_);  // hubs
};

}  // namespace shoal::link

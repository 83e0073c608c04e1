// SPDX-License-Identifier: Apache-2.0
// Endpoint of one process (or of one role's threads) on the link of its run. A hub makes writers
// and readers of the messages of message_list.h. common/dds connects processes; local_network.h
// connects the threads of one process. The code of a role includes only this header, writer.h and
// reader.h.
//
// tests/common/link checks the following contract for each implementation:
//
// - Reliable. A sample that Write accepted reaches every reader that was matched at that moment,
//   exactly once, in the order of the writer's calls. There are two exceptions: (1) the topic keeps
//   only the last n samples, and n newer samples of the same key were written before the reader
//   took the sample; (2) the writer or the reader ended before the reader took the sample. The
//   order holds for the samples of one writer, topic and key. A reader that is behind may get newer
//   samples of one key before older samples of another key.
// - History, keep_last = n. Write never blocks. The last n samples of each writer and key are kept;
//   a reader that is behind gets at least these samples.
// - History, keep_last = 0. Every sample is kept until all matched readers have it. The number of
//   unread bytes of a writer is bounded (UnreadBytesBound, role.h). At the bound, Write blocks for
//   at most max_blocking and then returns false. The sample was then not sent to any reader; the
//   caller keeps the sample and tries again. If nothing is unread, a single sample may be larger
//   than the bound.
// - Late joiners. If the topic has late_joiners, a reader first gets the last n samples per key of
//   each living writer, whenever the reader joins. Otherwise, a reader gets only the samples that
//   are written after the match.
// - Matching. A writer and a reader of one topic match when they have discovered each other. Until
//   then, the reader misses the samples of a topic without late joiners. Matched() is the number of
//   matched peers.
// - Liveness. "End" means a writer or a reader. An end that is destroyed is unmatched soon. If a
//   process dies without closing its ends, its peers unmatch these ends after at most
//   kLivenessLimit. Until then, samples that the dead process has not read count against the
//   writer's bound.
// - Restart. A new writer of a restarted process starts with an empty history. For up to
//   kLivenessLimit after the end of the earlier process, a reader may get late samples of this
//   process. Messages therefore contain the session of their sender, and receivers use the newest
//   session.
// - Threads. A reader's callback runs on a thread of the hub, one call at a time for each reader.
//   If writer and reader belong to the same hub, the callback may run on the writing thread. A
//   callback must not block, throw, or make or destroy writers and readers. Planes do not wait for
//   each other: a slow callback in one plane delays only the readers of this plane. Any thread may
//   use a writer, one thread at a time.
// - Memory. A message borrows its payload. Write copies the payload before it returns. The message
//   that a callback receives is valid during the call.
// - Damage. Samples that cannot be parsed, or are inconsistent, are counted by topic and not
//   delivered.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/link/message_list.h"
#include "common/link/role.h"
#include "common/wire/messages.h"

namespace shoal::link {

inline constexpr std::chrono::seconds kLivenessLimit{5};

// Upper bound of a payload in bytes. Receivers drop larger samples. For speed, chunks and parts
// should be smaller than 1 MB.
inline constexpr uint64_t kMaxPayloadBytes = 63'000'000;

// The implementation of a Writer<M>; writer.h describes the functions.
template <class M>
class WriterEnd {
 public:
  virtual ~WriterEnd() = default;
  virtual bool Write(const M& message) = 0;
  virtual int Matched() const = 0;
  virtual bool WaitForAcks(std::chrono::milliseconds deadline) = 0;
};

// The implementation of a Reader<M> (reader.h).
class ReaderEnd {
 public:
  virtual ~ReaderEnd() = default;
  virtual int Matched() const = 0;
  virtual uint64_t Malformed() const = 0;
};

// Tag that selects one of the overloads below.
template <class M>
struct MessageType {};

class Hub {
 public:
  // Writers and readers of the hub must be destroyed before the hub.
  virtual ~Hub() = default;

  // Number of samples that could not be read since the hub was made, by topic. Contains every topic
  // for which the hub has made a reader. Any thread.
  virtual std::map<std::string, uint64_t> Malformed() const = 0;

  // Only Writer<M> and Reader<M> call these functions. The functions throw Error if the
  // implementation cannot make the writer or the reader. The hub's role must join the topic's plane
  // (role.h).
#define SHOAL_LINK_ENDS(message, ...)                                               \
  virtual std::unique_ptr<WriterEnd<message>> MakeWriter(MessageType<message>) = 0; \
  virtual std::unique_ptr<ReaderEnd> MakeReader(MessageType<message>,               \
                                                std::function<void(const message&)>) = 0;
  SHOAL_MESSAGES(SHOAL_LINK_ENDS)
#undef SHOAL_LINK_ENDS
};

}  // namespace shoal::link

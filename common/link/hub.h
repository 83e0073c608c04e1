// SPDX-License-Identifier: Apache-2.0
// Endpoint of one process (or of one role's threads) on the link of its run. It makes writers and
// readers of the messages of message_list.h. common/dds connects processes; local_network.h
// connects the threads of one process. The code of a role includes this header, writer.h and
// reader.h only.
//
// tests/common/link checks the following contract for each implementation:
//
// - Reliable. A sample that Write accepted reaches every reader that was matched at that moment, in
//   the order of the writer's calls, exactly once. Exceptions: the topic keeps the last n and n
//   newer samples of the same key were written before the reader took it; or the writer or the
//   reader ends before. The order is that of one writer, topic and key: a reader that is behind may
//   get newer samples of one key before older ones of another.
// - History. keep_last = n: Write never blocks; per writer and key the last n samples are kept (a
//   reader that is behind gets at least these). keep_last = 0: every sample is kept until all
//   matched readers have it. A writer may have a bounded number of unread bytes
//   (UnreadBytesBound, role.h); then Write blocks, at most max_blocking, and returns false: the
//   sample was not sent to anybody, and the caller keeps it and tries again. If nothing is unread,
//   a single sample may be larger than the bound.
// - Late joiners. If the topic has late_joiners, a reader first gets the last n samples per key of
//   each living writer, whenever it joins. Otherwise, it gets the samples written after the match.
// - Matching. A writer and a reader of one topic match when they have discovered each other. Until
//   then, the reader misses the samples of a topic without late joiners. Matched() is the number of
//   matched peers.
// - Liveness. An end that is destroyed is unmatched soon. If a process dies without closing its
//   ends, its peers unmatch them after at most kLivenessLimit. Until then, samples that it has not
//   read count against the writer's bound.
// - Restart. A new writer of a restarted process has no history but its own. A reader may get late
//   samples of a predecessor up to kLivenessLimit after its end: messages carry the session of
//   their sender, and the receivers take the newest.
// - Threads. A reader's callback runs on a thread of the hub (or, where writer and reader share a
//   hub, on the writing thread), one call at a time per reader. It must not block, throw, or make
//   or destroy writers and readers. Planes do not wait for each other: a callback that is slow in
//   one plane delays the readers of that plane only. A writer may be used by any thread, one at a
//   time.
// - Memory. A message's payload is borrowed: Write copies it before it returns, and a callback's
//   message is valid during the call.
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

// Upper bound of a payload in bytes; receivers drop larger samples. For speed keep chunks and parts
// below 1 MB.
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
  // Writers and readers of the hub must be gone.
  virtual ~Hub() = default;

  // Number of samples that could not be read since the hub was made, by topic. Contains every topic
  // for which the hub has made a reader. Any thread.
  virtual std::map<std::string, uint64_t> Malformed() const = 0;

  // Only Writer<M> and Reader<M> call these functions. They throw Error when the implementation
  // cannot make the end. The hub's role must join the topic's plane.
#define SHOAL_LINK_ENDS(message, ...)                                               \
  virtual std::unique_ptr<WriterEnd<message>> MakeWriter(MessageType<message>) = 0; \
  virtual std::unique_ptr<ReaderEnd> MakeReader(MessageType<message>,               \
                                                std::function<void(const message&)>) = 0;
  SHOAL_MESSAGES(SHOAL_LINK_ENDS)
#undef SHOAL_LINK_ENDS
};

}  // namespace shoal::link

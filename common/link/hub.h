// SPDX-License-Identifier: Apache-2.0
// The place of one process (or of one role's threads) on its run's link: writers and readers of the
// messages of message_list.h are made here. common/dds connects processes, local_network.h the
// threads of one process. The code of a role knows this header, writer.h, reader.h and no more.
//
// The contract, which tests/common/link checks for each implementation:
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
// - Late joiners. With late_joiners a reader first gets the last n samples per key of each living
//   writer, whenever it joins; without, it gets what is written after the match.
// - Matching. A writer and a reader of one topic match when both are known to each other; until
//   then a sample of a topic without late joiners goes past the reader. Matched() counts.
// - Liveness. An end that is destroyed is unmatched soon. The peers of a process that died without
//   a word are unmatched after at most kLivenessLimit; until then its unread samples count against
//   the writer's bound.
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
// - Damage. What cannot be read, or makes no sense, is counted by topic and not delivered.
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

// The implementation of a Writer<M> (writer.h), whose functions are the same.
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

// Chooses among the overloads below.
template <class M>
struct MessageType {};

class Hub {
 public:
  // Writers and readers of the hub must be gone.
  virtual ~Hub() = default;

  // Samples that could not be read, by topic, since the hub was made: every topic that a reader of
  // the hub read at some time. Any thread.
  virtual std::map<std::string, uint64_t> Malformed() const = 0;

  // For Writer<M> and Reader<M>. Throw Error when the implementation refuses. The hub's role must
  // join the topic's plane.
#define SHOAL_LINK_ENDS(message, ...)                                               \
  virtual std::unique_ptr<WriterEnd<message>> MakeWriter(MessageType<message>) = 0; \
  virtual std::unique_ptr<ReaderEnd> MakeReader(MessageType<message>,               \
                                                std::function<void(const message&)>) = 0;
  SHOAL_MESSAGES(SHOAL_LINK_ENDS)
#undef SHOAL_LINK_ENDS
};

}  // namespace shoal::link

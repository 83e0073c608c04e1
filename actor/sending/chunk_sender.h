// SPDX-License-Identifier: Apache-2.0
// Sends the chunks of a window over a link: receives credits, closes partial chunks in time, sends
// chunks that have credit, and resends chunks that have not been acknowledged for too long.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "actor/sending/chunk_link.h"
#include "actor/sending/chunk_window.h"
#include "common/base/clock.h"
#include "common/base/error.h"

namespace shoal::actor {

// Another process with this actor's number has started later. The session of the other process
// replaces this session.
class SupersededError : public Error {
 public:
  SupersededError(uint32_t actor, uint64_t session);
  uint64_t session() const { return session_; }  // of the other process

 private:
  uint64_t session_;
};

// Borrows window and link. One thread.
class ChunkSender {
 public:
  // If no sent chunk is acknowledged, or no credit arrives, for longer than this time, all retained
  // records are resent. The replay repeats every credit once a second. Silence therefore means that
  // the replay does not know this session: the replay is a new process without the earlier records.
  static constexpr std::chrono::seconds kResendAfter{2};

  struct Options {
    uint64_t spec_hash = 0;
    std::string spec_summary = {};            // for the error if the replay has another spec
    std::chrono::milliseconds flush_after{};  // a partial chunk is sent after this long
    std::function<SteadyTime()> now = Now;
  };
  ChunkSender(ChunkWindow& window, ChunkLink& link, const Options& options);

  // Receives credits (waits for credits until `deadline`) and sends the chunks that the credits
  // allow. If the replay has another observation spec, throws Error naming both specs. Throws
  // SupersededError if another process has this actor's number.
  void Exchange(SteadyTime deadline);
  // Makes a partial chunk ready to be sent by the next Exchange.
  void Flush() { window_.Flush(); }

  const ChunkWindow& window() const { return window_; }
  // Chunks that the transport did not accept in time.
  uint64_t write_timeouts() const { return write_timeouts_; }
  // Time spent passing chunks to the transport.
  double publish_seconds() const { return publish_seconds_; }

 private:
  void Hear(SteadyTime deadline);
  void Send();

  ChunkWindow& window_;
  ChunkLink& link_;
  const Options options_;
  SteadyTime last_flush_, last_progress_, last_heard_;
  uint64_t write_timeouts_ = 0;
  double publish_seconds_ = 0;
};

}  // namespace shoal::actor

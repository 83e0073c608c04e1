// SPDX-License-Identifier: Apache-2.0
// Sends the chunks of a window over a link: receives credits, closes partial chunks in time, sends
// chunks that have credit, and resends chunks that were not reported stored for too long.
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

// Another process has this actor's number and began later, so its session supersedes this one.
class SupersededError : public Error {
 public:
  SupersededError(uint32_t actor, uint64_t session);
  uint64_t session() const { return session_; }  // its

 private:
  uint64_t session_;
};

// Borrows window and link. One thread.
class ChunkSender {
 public:
  // If for longer than this no sent chunk is acknowledged, or no credit arrives, everything is
  // resent. Every credit is repeated once a second: silence means that the replay does not know
  // this session, because it does not know the records that its predecessor stored.
  static constexpr std::chrono::seconds kResendAfter{2};

  struct Options {
    uint64_t spec_hash = 0;
    std::string spec_summary = {};            // for the refusal of another replay's spec
    std::chrono::milliseconds flush_after{};  // a partial chunk is sent after this long
    std::function<SteadyTime()> now = Now;
  };
  ChunkSender(ChunkWindow& window, ChunkLink& link, const Options& options);

  // Receives credits (waits for them until `deadline`) and sends chunks within them. Throws Error
  // naming both sides when the replay's observation spec is another one; SupersededError.
  void Exchange(SteadyTime deadline);
  // Makes a partial chunk ready to be sent by the next Exchange.
  void Flush() { window_.Flush(); }

  const ChunkWindow& window() const { return window_; }
  // Chunks that the transport did not accept in time.
  uint64_t write_timeouts() const { return write_timeouts_; }
  // Time spent in handing chunks to the transport.
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

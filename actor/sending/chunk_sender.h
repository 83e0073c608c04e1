// SPDX-License-Identifier: Apache-2.0
// Keeps a chunk window and a link going: hears credits, closes partial chunks in time, sends what
// may be sent, sends again what was not reported stored for too long.
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

// Another process has this actor's number and began later: it is the one that is believed.
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
  // Without progress on what was sent, or without a credit, for longer than this, everything is
  // sent again. Every credit is repeated once a second: silence is a replay that does not know this
  // session, because it does not know what its predecessor stored.
  static constexpr std::chrono::seconds kResendAfter{2};

  struct Options {
    uint64_t spec_hash = 0;
    std::string spec_summary = {};            // for the refusal of another replay's spec
    std::chrono::milliseconds flush_after{};  // a partial chunk is sent after this long
    std::function<SteadyTime()> now = Now;
  };
  ChunkSender(ChunkWindow& window, ChunkLink& link, const Options& options);

  // Hears the replay (waiting for it until `deadline`) and sends what may be sent. Throws Error
  // naming both sides when the replay's observation spec is another one; SupersededError.
  void Exchange(SteadyTime deadline);
  // Makes a partial chunk ready to be sent by the next Exchange.
  void Flush() { window_.Flush(); }

  const ChunkWindow& window() const { return window_; }
  // Chunks that the transport did not take in its time.
  uint64_t write_timeouts() const { return write_timeouts_; }
  // Spent handing chunks to the transport.
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

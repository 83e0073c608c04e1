// SPDX-License-Identifier: Apache-2.0
// A chunk and the credit that answers it, as between an actor and a replay.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "common/link/reader.h"
#include "common/link/writer.h"
#include "tests/common/link/peer_commands.h"

namespace shoal::link {

// Answers each chunk with a credit from a thread of its own, as a replay does.
class PeerCommands::Answerer {
 public:
  explicit Answerer(Hub& hub);

 private:
  void Run(const std::stop_token& stop);

  Writer<CreditsMessage> writer_;
  std::mutex mutex_;
  std::condition_variable_any arrived_;
  uint64_t newest_ = 0;  // guarded by mutex_
  std::jthread thread_;
  Reader<TransitionChunk> reader_;
};

// The command "roundtrip": its answer.
std::string RoundTrip(Hub& hub, uint64_t count, size_t payload_bytes);

}  // namespace shoal::link

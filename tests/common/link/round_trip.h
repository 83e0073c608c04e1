// SPDX-License-Identifier: Apache-2.0
// Round trips of a chunk and its credit, as between actor and replay.
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

// Answers each chunk with a credit from a separate thread, like a replay.
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

// Executes the command "roundtrip" and returns its answer.
std::string RoundTrip(Hub& hub, uint64_t count, size_t payload_bytes);

}  // namespace shoal::link

// SPDX-License-Identifier: Apache-2.0
// Measures how fast DDS transfers 1 MB chunks between two processes of this machine, through
// common/dds and with the credits of a run.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "common/config/config.h"
#include "launch/check/check_line.h"

namespace shoal::launch {

struct LoopbackRate {
  uint64_t chunks = 0;  // chunks that arrived in order
  uint64_t bytes = 0;
  double seconds = 0;  // from the first chunk to the last acknowledgement

  double MegabytesPerSecond() const {
    return seconds > 0 ? static_cast<double>(bytes) / seconds / 1e6 : 0;
  }
};

// Starts a second process of this program (RunLoopbackPeer) and sends chunks of 1 MB for
// `duration`. At most four chunks are unacknowledged at a time. Returns the counts of the arrived
// chunks. Throws Error if the two processes do not discover each other, or if a chunk is not
// acknowledged in time.
LoopbackRate MeasureLoopback(const TransportConfig& transport, std::chrono::milliseconds duration);

// The second process: acknowledges chunks until a stop request arrives. `folder` holds
// cluster.json.
int RunLoopbackPeer(const std::filesystem::path& folder, const TransportConfig& transport);

// `needed`: MB/s of records that actors of the default preset send.
CheckLine JudgeLoopback(const LoopbackRate& rate, double needed);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Does learning work here? A few updates on batches of real frames, then a checkpoint that is
// written, read again and compared.
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/config/config.h"
#include "launch/check/check_line.h"

namespace shoal::launch {

struct TrainingProbe {
  uint64_t env_steps = 0, updates = 0;
  double env_steps_per_second = 0;  // of one thread, with rendering and storing
  double updates_per_second = 0;    // of one thread
  bool finite = false;              // every update was
  bool moved = false;               // the policy's parameters are not those of the start
  uint64_t checkpoint_bytes = 0;
  bool restored = false;   // an agent restored from the checkpoint has the same tensors, bit by bit
  bool continued = false;  // and does the next update bit by bit as the first one does
};

// Trains `config` for `updates` updates with everything in this process; its files go to `folder`.
// Throws Error: no rendering, no room, a checkpoint that cannot be written or read.
TrainingProbe ProbeTraining(const Config& config, const std::filesystem::path& folder, int updates);

CheckLine JudgeTraining(const TrainingProbe& probe);

}  // namespace shoal::launch

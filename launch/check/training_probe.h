// SPDX-License-Identifier: Apache-2.0
// Tests learning on this machine: makes a few updates on batches of real frames, then writes a
// checkpoint, reads the checkpoint again and compares the tensors.
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
  bool finite = false;              // all numbers of all updates were finite
  bool moved = false;               // the policy's parameters have changed
  uint64_t checkpoint_bytes = 0;
  bool restored = false;   // an agent restored from the checkpoint has the same tensors bit by bit
  bool continued = false;  // the restored agent's next update equals the first agent's bit by bit
};

// Trains `config` for `updates` updates in this process and writes files to `folder`. Throws Error
// if rendering fails, space is missing, or the checkpoint cannot be written or read.
TrainingProbe ProbeTraining(const Config& config, const std::filesystem::path& folder, int updates);

CheckLine JudgeTraining(const TrainingProbe& probe);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// A checkpoint for the learner: its files (common/checkpoint) and the tensors in the files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/checkpoint/checkpoint_files.h"
#include "common/config/run_config.h"
#include "common/nn/precision.h"
#include "common/nn/safetensors.h"

namespace shoal::learner {

struct Checkpoint {
  CheckpointState state;
  nn::TensorMap tensors;    // of learner.safetensors
  std::string description;  // policy.json; empty if there is none
  std::filesystem::path folder;
};

// See WriteCheckpointFiles. `described`: the policy's description, written to policy.json.
void WriteCheckpoint(const std::filesystem::path& parent, const CheckpointState& state,
                     const nn::TensorMap& learner, const nn::TensorMap& policy,
                     const RunConfig& described, const nlohmann::ordered_json& meta);

// See ReadCheckpointFiles.
Checkpoint ReadCheckpoint(const std::filesystem::path& folder, uint64_t spec_hash);

// A resumed run repeats exactly only in the precision of the checkpoint. `asked` is
// learner.precision, `chosen` the precision on this machine. If the checkpoint's precision differs
// from `chosen`: throws Error (kUsage) with a remedy if `asked` is auto, else returns a warning.
// Empty if they agree.
std::string CheckPrecision(const Checkpoint& checkpoint, const std::string& asked,
                           nn::Precision chosen);

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
// A checkpoint as the learner uses it: the files (common/checkpoint) and the tensors in the files.
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
  nn::TensorMap tensors;    // tensors of learner.safetensors
  std::string description;  // text of policy.json; empty if the checkpoint has no policy.json
  std::filesystem::path folder;
};

// See WriteCheckpointFiles. `described`: the policy's description, written to policy.json.
void WriteCheckpoint(const std::filesystem::path& parent, const CheckpointState& state,
                     const nn::TensorMap& learner, const nn::TensorMap& policy,
                     const RunConfig& described, const nlohmann::ordered_json& meta);

// See ReadCheckpointFiles.
Checkpoint ReadCheckpoint(const std::filesystem::path& folder, uint64_t spec_hash);

// Checks the precision of a checkpoint, because a resumed run repeats exactly only in the same
// precision. `asked`: value of learner.precision. `chosen`: precision on this machine. If the
// checkpoint's precision is `chosen`, returns an empty text. If the precisions differ and `asked`
// is "auto", throws Error (kUsage) with a remedy; otherwise, returns a warning.
std::string CheckPrecision(const Checkpoint& checkpoint, const std::string& asked,
                           nn::Precision chosen);

}  // namespace shoal::learner

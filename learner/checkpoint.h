// A checkpoint as the learner sees it: its files (common/checkpoint) with the tensors in them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "common/checkpoint/checkpoint_files.h"
#include "common/nn/safetensors.h"

namespace shoal::learner {

struct Checkpoint {
  CheckpointState state;
  nn::TensorMap tensors;  // of learner.safetensors
  std::filesystem::path folder;
};

// As WriteCheckpointFiles.
void WriteCheckpoint(const std::filesystem::path& parent, const CheckpointState& state,
                     const nn::TensorMap& learner, const nn::TensorMap& policy,
                     const nlohmann::ordered_json& meta);

// As ReadCheckpointFiles.
Checkpoint ReadCheckpoint(const std::filesystem::path& folder, uint64_t spec_hash);

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
// Writes and reads the files of a checkpoint. A checkpoint is a folder step_UPDATES (nine digits)
// with these files:
//
//   learner.safetensors  all data that are necessary to resume the training exactly
//   policy.safetensors   parameters of the policy, F32
//   policy.json          description of the policy (common/policy/policy_description.h); missing in
//                        checkpoints of old versions
//   state.json           schema shoal-checkpoint-1: counters, session, hashes, precision,
//                        algorithm, size and CRC-32 of these files, and a CRC-32 of itself
//   .meta.json           schema shoal-checkpoint-meta-1: origin of the checkpoint, for people and
//                        tools
//
// Readers never see a partial checkpoint: the writer makes a folder with another name, calls fsync
// for every file, renames the folder, and calls fsync for the parent folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace shoal {

inline constexpr char kLearnerFile[] = "learner.safetensors";
inline constexpr char kPolicyFile[] = "policy.safetensors";
inline constexpr char kDescriptionFile[] = "policy.json";
inline constexpr char kStateFile[] = "state.json";
inline constexpr char kStateSchema[] = "shoal-checkpoint-1";
inline constexpr char kCheckpointMetaFile[] = ".meta.json";
inline constexpr char kCheckpointMetaSchema[] = "shoal-checkpoint-meta-1";

struct CheckpointState {
  uint64_t updates = 0;
  uint64_t env_steps = 0;         // env steps stored when the last batch was drawn
  uint64_t request = 0;           // request number of the last batch
  uint64_t learner_session = 0;   // session of the learner that wrote the checkpoint
  uint64_t config_hash = 0;       // hash of the run's resolved configuration
  uint64_t spec_hash = 0;         // hash of the observation spec
  std::string precision;          // "f32" | "bf16": type of large products; parameters are F32
  std::string algorithm = "sac";  // learner.algorithm

  bool operator==(const CheckpointState&) const = default;
};

struct CheckpointFiles {
  CheckpointState state;
  std::string learner, policy;  // safetensors
  std::string description;      // policy.json; empty: the checkpoint has none
};

// "step_000002000"
std::string CheckpointName(uint64_t updates);
// The number of updates in the name of a checkpoint; empty for any other name.
std::optional<uint64_t> CheckpointUpdates(const std::string& name);

// Writes PARENT/step_UPDATES and replaces an existing checkpoint of this name. `meta`: content of
// .meta.json. Throws Error naming the file, for example if the disk is full. After an error, there
// is no partial checkpoint, and an existing checkpoint of this name is unchanged.
void WriteCheckpointFiles(const std::filesystem::path& parent, const CheckpointFiles& files,
                          const nlohmann::ordered_json& meta);

// Reads a checkpoint and verifies every byte of its files except .meta.json. Throws Error that
// names the file and the expectation if a file is missing, truncated or altered, or has another
// schema. If `spec_hash` is given, also throws Error if the checkpoint has another observation
// spec.
CheckpointFiles ReadCheckpointFiles(const std::filesystem::path& folder);
CheckpointFiles ReadCheckpointFiles(const std::filesystem::path& folder, uint64_t spec_hash);
// Reads all files except learner.safetensors, which need not exist. CheckpointFiles::learner is
// empty.
CheckpointFiles ReadPolicyFiles(const std::filesystem::path& folder);

}  // namespace shoal

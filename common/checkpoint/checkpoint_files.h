// SPDX-License-Identifier: Apache-2.0
// The files of one checkpoint, as bytes: a folder step_UPDATES (nine digits) with
//
//   learner.safetensors  everything an exact resume needs
//   policy.safetensors   what an actor needs, F32
//   policy.json          what is to be known to act by it (common/policy/policy_description.h);
//                        checkpoints of former versions have none
//   state.json           schema shoal-checkpoint-1: counters, session, hashes, precision,
//                        algorithm, size and CRC-32 of these files, and a CRC-32 of itself
//   .meta.json           schema shoal-checkpoint-meta-1: where it comes from, for people and tools
//
// It appears whole or not at all: written as a folder of another name, every file synced, renamed,
// the parent folder synced.
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
  uint64_t env_steps = 0;         // stored in the replay when the last batch was drawn
  uint64_t request = 0;           // of that batch
  uint64_t learner_session = 0;   // that wrote it
  uint64_t config_hash = 0;       // of the run's resolved configuration
  uint64_t spec_hash = 0;         // of the observation spec
  std::string precision;          // "f32" | "bf16": of the products; parameters are F32 either way
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
// The number of updates in such a name; none for any other name.
std::optional<uint64_t> CheckpointUpdates(const std::string& name);

// Writes PARENT/step_UPDATES, in place of one of that name. `meta` becomes .meta.json. Throws Error
// naming the file (disk full, not writable); then nothing is left behind and a former checkpoint of
// the name is untouched.
void WriteCheckpointFiles(const std::filesystem::path& parent, const CheckpointFiles& files,
                          const nlohmann::ordered_json& meta);

// Reads a checkpoint and verifies every byte but .meta.json. Throws Error naming the file and what
// was expected: missing, truncated or altered files, another schema; with `spec_hash`, another
// observation spec.
CheckpointFiles ReadCheckpointFiles(const std::filesystem::path& folder);
CheckpointFiles ReadCheckpointFiles(const std::filesystem::path& folder, uint64_t spec_hash);
// The same without `learner`, which need not be there: what acting takes.
CheckpointFiles ReadPolicyFiles(const std::filesystem::path& folder);

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// The checkpoints of a run: RUN/checkpoints. Keeps the newest three checkpoints and the checkpoints
// whose evaluation is pending. Never removes `best`, which belongs to the coordinator, or files
// with other names.
//
// Only one thread may use the store, and only one learner in each run.
#pragma once

#include <chrono>
#include <deque>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "common/base/clock.h"
#include "common/base/write_faults.h"
#include "common/config/run_config.h"
#include "learner/checkpoint.h"

namespace shoal::learner {

class CheckpointStore {
 public:
  // Makes the folder, and removes incomplete files that a killed learner left. Throws Error.
  CheckpointStore(const std::filesystem::path& run_folder, const RunConfig& run);

  // Hash of the configuration with every default; the state's config_hash.
  uint64_t config_hash() const { return config_hash_; }

  // Returns the newest valid checkpoint; empty in a new run. Damaged checkpoints that are newer are
  // renamed to refused_NAME, with a warning that gives the reason. If there are checkpoints but
  // none is valid, throws Error that names the fault of the newest checkpoint.
  std::optional<Checkpoint> RestoreNewest();

  // Writes a checkpoint, returns its name, and removes old checkpoints, except those in `wanted`.
  // If the checkpoint cannot be written, this is reported, and the checkpoint is kept in memory. A
  // later call of Write or Retry writes it; until then, no earlier checkpoint is removed. Only the
  // newest kMostUnwritten checkpoints stay in memory.
  std::string Write(const CheckpointState& state, nn::TensorMap learner, nn::TensorMap policy,
                    const std::set<std::string>& wanted);
  // Tries again to write the checkpoints in memory. Unless `now` is set, tries at most once in each
  // kRetryPeriod.
  void Retry(const std::set<std::string>& wanted, bool now = false);
  size_t unwritten() const { return unwritten_.size(); }
  // Updates of the newest checkpoint that is not written yet; empty if all are written.
  std::optional<uint64_t> UnwrittenUpdates() const;
  // Updates of the newest checkpoint on the disk.
  std::optional<uint64_t> WrittenUpdates() const;

  static constexpr size_t kKept = 3, kMostUnwritten = 2;
  static constexpr std::chrono::seconds kRetryPeriod{10};

 private:
  struct Unwritten {
    CheckpointState state;
    nn::TensorMap learner, policy;
  };

  void WriteKept(const std::set<std::string>& wanted);
  void Prune(const std::set<std::string>& wanted);
  std::vector<uint64_t> Existing() const;  // updates, newest first
  void Remove(const std::string& name);
  nlohmann::ordered_json Meta(const CheckpointState& state) const;

  const std::filesystem::path folder_;
  const RunConfig run_;
  const uint64_t config_hash_;
  const std::string config_text_;
  WriteFaults faults_;
  std::deque<Unwritten> unwritten_;  // oldest first
  SteadyTime tried_{};
};

}  // namespace shoal::learner

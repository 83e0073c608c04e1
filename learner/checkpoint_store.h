// SPDX-License-Identifier: Apache-2.0
// The checkpoints of a run: RUN/checkpoints. Keeps the newest three and those that an evaluation is
// still waited for; `best`, which is the coordinator's, and everything of another name stay.
//
// One thread, one learner per run.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>

#include "common/config/run_config.h"
#include "learner/checkpoint.h"

namespace shoal::learner {

class CheckpointStore {
 public:
  // Makes the folder and removes what a killed learner left half-written. Throws Error.
  CheckpointStore(const std::filesystem::path& run_folder, const RunConfig& run);

  // Of the configuration with every default; the state's config_hash.
  uint64_t config_hash() const { return config_hash_; }

  // The newest checkpoint that is whole; none in a new run. Newer broken ones are set aside as
  // refused_NAME with a warning that says why. Throws Error, naming the newest one's fault, when
  // there are checkpoints but none can be used.
  std::optional<Checkpoint> RestoreNewest();

  // Writes one and removes those not kept any more, except the names in `wanted`. Returns its name.
  // Throws Error (WriteCheckpoint); the earlier checkpoints are then all still there.
  std::string Write(const CheckpointState& state, const nn::TensorMap& learner,
                    const nn::TensorMap& policy, const std::set<std::string>& wanted);

  static constexpr size_t kKept = 3;

 private:
  std::vector<uint64_t> Existing() const;  // updates, newest first
  void Remove(const std::string& name);
  nlohmann::ordered_json Meta(const CheckpointState& state) const;

  const std::filesystem::path folder_;
  const RunConfig run_;
  const uint64_t config_hash_;
};

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/checkpoint.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "common/base/error.h"
#include "common/nn/policy.h"
#include "common/policy/policy_description.h"

namespace shoal::learner {

void WriteCheckpoint(const std::filesystem::path& parent, const CheckpointState& state,
                     const nn::TensorMap& learner, const nn::TensorMap& policy,
                     const RunConfig& described, const nlohmann::ordered_json& meta) {
  const nn::ActorOutput output = nn::ActorOutputOf(policy, described.spec.action_size);
  const std::map<std::string, std::string> metadata{{"format", "shoal"},
                                                    {"updates", std::to_string(state.updates)}};
  WriteCheckpointFiles(parent,
                       {.state = state,
                        .learner = nn::WriteSafetensors(learner, metadata),
                        .policy = nn::WriteSafetensors(policy, metadata),
                        .description = policy::WriteDescription(
                            policy::Describe(described.config, described.spec, output))},
                       meta);
}

Checkpoint ReadCheckpoint(const std::filesystem::path& folder, uint64_t spec_hash) {
  CheckpointFiles files = ReadCheckpointFiles(folder, spec_hash);
  return {.state = files.state,
          .tensors = nn::ReadSafetensors(files.learner, (folder / kLearnerFile).string()),
          .description = std::move(files.description),
          .folder = folder};
}

std::string CheckPrecision(const Checkpoint& checkpoint, const std::string& asked,
                           nn::Precision chosen) {
  const std::string name = checkpoint.folder.filename().string();
  const std::string& before = checkpoint.state.precision;
  const char* now = nn::ToString(chosen);
  if (before == now) return "";
  if (asked == "auto") {
    throw UsageError(
        "{} was computed in {}, this CPU would use {} (learner.precision = auto, CPU {}): continue "
        "with --set learner.precision={} if the CPU supports it, or accept the other arithmetic "
        "with --set learner.precision={}",
        name, before, now, nn::CpuIsa(), before, now);
  }
  return fmt::format(
      "{} was computed in {}, its continuation uses {} (learner.precision = {}): the run does not "
      "continue exactly as before",
      name, before, now, asked);
}

}  // namespace shoal::learner

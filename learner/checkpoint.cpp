#include "learner/checkpoint.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace shoal::learner {

void WriteCheckpoint(const std::filesystem::path& parent, const CheckpointState& state,
                     const nn::TensorMap& learner, const nn::TensorMap& policy,
                     const nlohmann::ordered_json& meta) {
  const std::map<std::string, std::string> metadata{{"format", "shoal"},
                                                    {"updates", std::to_string(state.updates)}};
  WriteCheckpointFiles(parent,
                       {.state = state,
                        .learner = nn::WriteSafetensors(learner, metadata),
                        .policy = nn::WriteSafetensors(policy, metadata)},
                       meta);
}

Checkpoint ReadCheckpoint(const std::filesystem::path& folder, uint64_t spec_hash) {
  const CheckpointFiles files = ReadCheckpointFiles(folder, spec_hash);
  return {.state = files.state,
          .tensors = nn::ReadSafetensors(files.learner, (folder / "learner.safetensors").string()),
          .folder = folder};
}

}  // namespace shoal::learner

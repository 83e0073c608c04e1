// SPDX-License-Identifier: Apache-2.0
#include "common/policy/checkpoint_policy.h"

#include <string>

#include "common/base/error.h"
#include "common/config/run_files.h"
#include "common/nn/plan_text.h"
#include "common/nn/policy.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::policy {
namespace {

namespace fs = std::filesystem;

// Description of a checkpoint without policy.json, from the run that contains the checkpoint.
PolicyDescription DescribeByRun(const fs::path& folder, const CheckpointPolicy& policy) {
  const fs::path checkpoints = fs::weakly_canonical(folder).parent_path();
  for (const fs::path& run : {checkpoints.parent_path(), checkpoints.parent_path().parent_path()}) {
    if (!fs::exists(run / kConfigFile)) continue;
    const auto [config, spec] = ReadRunConfig(run);
    if (spec.Hash() != policy.state.spec_hash) continue;  // the checkpoint belongs to another run
    return Describe(config, spec, nn::ActorOutputOf(policy.tensors, spec.action_size));
  }
  throw RuntimeError(
      "'{}' has no {}, and no config.json of its run is above it: a former version of Shoal wrote "
      "it; expected RUN/checkpoints/NAME, or a checkpoint of this version",
      folder.string(), kDescriptionFile);
}

// Files of different checkpoints, combined by hand, are each valid by themselves.
void CheckAgreement(const fs::path& folder, const CheckpointPolicy& policy) {
  const auto& [description, tensors, state] = policy;
  const std::string file = (folder / kDescriptionFile).string();
  if (description.spec.Hash() != state.spec_hash) {
    throw RuntimeError("'{}': observation spec {:016x}, but the checkpoint's is {:016x}", file,
                       description.spec.Hash(), state.spec_hash);
  }
  if (description.algorithm != state.algorithm) {
    throw RuntimeError("'{}': algorithm '{}', but the checkpoint's is '{}'", file,
                       description.algorithm, state.algorithm);
  }
  const nn::ActorOutput found = nn::ActorOutputOf(tensors, description.spec.action_size);
  if (found != description.output) {
    throw RuntimeError("'{}': output {}, but {} holds a policy that is {}", file,
                       nn::ToString(description.output), kPolicyFile, nn::ToString(found));
  }
}

}  // namespace

CheckpointPolicy ReadCheckpointPolicy(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw RuntimeError("'{}': expected a folder with a checkpoint", folder.string());
  }
  const CheckpointFiles files = ReadPolicyFiles(folder);
  CheckpointPolicy policy;
  policy.state = files.state;
  policy.tensors = nn::ReadSafetensors(files.policy, (folder / kPolicyFile).string());
  if (files.description.empty()) {
    policy.description = DescribeByRun(folder, policy);
  } else {
    policy.description = ReadDescription(files.description, (folder / kDescriptionFile).string());
    CheckAgreement(folder, policy);
  }
  return policy;
}

}  // namespace shoal::policy

// SPDX-License-Identifier: Apache-2.0
// Inputs of a run's policy (the same in training and at test time), and the privileged inputs of
// learning. Used for the run's first lines, for meta.json and for `shoal env describe --run`.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/config/run_config.h"
#include "common/spec/observation_spec.h"

namespace shoal::launch {

// Inputs of the policy.
struct PolicyInputs {
  std::vector<std::string> blocks{};  // in the order of the policy's vector
  // Those of `blocks` that reveal the object's pose. Reported results must list these blocks,
  // because locating the object is part of a task from pixels.
  std::vector<std::string> object_blocks{};
  std::vector<std::string> cameras{};  // empty: no pixels
  bool goal_picture = false;           // the policy also gets a goal picture of each camera
};
// The blocks of an object are found by name. They are all blocks that begin with "object". If such
// a block is recorded, `achieved_goal` also belongs to the object.
PolicyInputs PolicyInputsOf(const ObservationSpec& spec);

// Privileged inputs of learning (common/config/privileged_blocks.h).
struct PrivilegedInputs {
  std::vector<std::string> critic_blocks{};  // inputs of the critic in place of the pixels
  std::vector<std::string> labels{};         // names in sac.aux
  // Blocks with which the replay relabels goals and draws samples, if the policy sees them only in
  // pictures.
  std::vector<std::string> replay_blocks{};
};
// Throws the errors (usage) of PrivilegedBlocksOf.
PrivilegedInputs PrivilegedInputsOf(const Config& config, const ObservationSpec& spec);

// The form in meta.json.
nlohmann::ordered_json ToJson(const PolicyInputs& inputs);
nlohmann::ordered_json ToJson(const PrivilegedInputs& inputs);

// "relabels goals with achieved_goal and draws 50 % of the samples by its remaining path length";
// empty if the replay uses no privileged block.
std::string HindsightText(const RunConfig& run);

// All inputs as text for people; each line ends with a newline.
std::string DescribeInputs(const RunConfig& run);
// All inputs as JSON for programs, schema shoal-inputs-1.
nlohmann::ordered_json InputsJson(const RunConfig& run);

}  // namespace shoal::launch

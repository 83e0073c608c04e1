// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/policy_actions.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "common/base/check.h"
#include "common/policy/trained_policy.h"
#include "launch/tools/export/onnx_evaluator.h"
#include "launch/tools/export/onnx_policy.h"

namespace shoal::launch {

std::vector<float> OwnActions(const policy::CheckpointPolicy& policy,
                              const ObservationSet& observations) {
  policy::TrainedPolicy trained(policy);
  const auto values = BlocksOf(trained.spec(), observations);
  std::vector<policy::ObservedBlock> blocks;
  blocks.reserve(values.size());
  for (const auto& [name, block] : values) blocks.push_back({name, block});
  std::vector<float> actions(size_t(observations.count) * size_t(trained.spec().action_size));
  trained.Act({.count = observations.count, .pixels = observations.frames, .blocks = blocks},
              actions);
  return actions;
}

std::vector<float> OnnxActions(const OnnxModel& model, const ObservationSpec& spec,
                               const ObservationSet& observations) {
  std::map<std::string, OnnxTensor> inputs;
  const auto blocks = BlocksOf(spec, observations);
  for (const OnnxPort& port : model.inputs) {
    OnnxTensor& input = inputs[port.name];
    input.shape = port.shape;
    input.shape.insert(input.shape.begin(), observations.count);
    if (port.name == kPixelsInput) {
      input.values.assign(observations.frames.begin(), observations.frames.end());
    } else {
      CHECK(blocks.contains(port.name)) << port.name;
      input.values = blocks.at(port.name);
    }
  }
  return OnnxEvaluator(model).Run(inputs).values;
}

Agreement Compare(const std::vector<float>& ours, const std::vector<float>& theirs,
                  int observations) {
  CHECK(ours.size() == theirs.size() && !ours.empty()) << ours.size() << " and " << theirs.size();
  Agreement result{.observations = observations,
                   .least = *std::ranges::min_element(ours),
                   .most = *std::ranges::max_element(ours)};
  for (size_t i = 0; i < ours.size(); ++i) {
    const float difference = std::abs(ours[i] - theirs[i]);
    result.largest_difference = std::isnan(difference)
                                    ? std::numeric_limits<float>::infinity()
                                    : std::max(result.largest_difference, difference);
  }
  return result;
}

}  // namespace shoal::launch

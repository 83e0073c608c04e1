// SPDX-License-Identifier: Apache-2.0
// Actions of one policy, (N, A) in [-1, 1], computed by Shoal and by the exported file.
#pragma once

#include <vector>

#include "common/policy/checkpoint_policy.h"
#include "launch/tools/export/observations.h"
#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

// Actions of Shoal's own networks in f32, without exploration. Throws Error if a tensor does not
// match or an action is not finite.
std::vector<float> OwnActions(const policy::CheckpointPolicy& policy,
                              const ObservationSet& observations);

// Actions of the exported model, computed by the plain evaluator (onnx_evaluator.h). Throws Error
// if the model cannot run.
std::vector<float> OnnxActions(const OnnxModel& model, const ObservationSpec& spec,
                               const ObservationSet& observations);

// Result of a comparison of two lists of actions.
struct Agreement {
  int observations = 0;
  float largest_difference = 0;  // infinite if an action is not a number
  float least = 0, most = 0;     // smallest and largest action of the first list
};
Agreement Compare(const std::vector<float>& ours, const std::vector<float>& theirs,
                  int observations);

}  // namespace shoal::launch

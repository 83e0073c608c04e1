// SPDX-License-Identifier: Apache-2.0
// The actions of one policy, (N, A) in [-1, 1], computed by Shoal and by what was exported.
#pragma once

#include <vector>

#include "common/policy/checkpoint_policy.h"
#include "launch/tools/export/observations.h"
#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

// By our own networks in f32, without exploration. Throws Error where a tensor does not fit or an
// action is not finite.
std::vector<float> OwnActions(const policy::CheckpointPolicy& policy,
                              const ObservationSet& observations);

// By the plain evaluator (onnx_evaluator.h). Throws Error where the model cannot run.
std::vector<float> OnnxActions(const OnnxModel& model, const ObservationSpec& spec,
                               const ObservationSet& observations);

// Result of a comparison of two lists of actions.
struct Agreement {
  int observations = 0;
  float largest_difference = 0;  // infinite where an action is not a number
  float least = 0, most = 0;     // of the first list's actions
};
Agreement Compare(const std::vector<float>& ours, const std::vector<float>& theirs,
                  int observations);

}  // namespace shoal::launch

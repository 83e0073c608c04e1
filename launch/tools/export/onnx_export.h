// SPDX-License-Identifier: Apache-2.0
// Converts a checkpoint's policy to the bytes of an ONNX file and verifies that the file computes
// the same actions.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/export/policy_actions.h"

namespace shoal::launch {

// Largest allowed difference between the actions of an exported policy and the actions of Shoal's
// policy, in f32.
inline constexpr float kMostDifference = 1e-4f;

struct OnnxExport {
  std::string bytes;
  std::vector<Agreement> agreements;  // one for each set of observations
};

// Writes the model, reads the bytes back, and evaluates the model with plain operators on each set.
// If an action differs by more than kMostDifference, throws Error stating the difference.
OnnxExport ExportOnnx(const policy::CheckpointPolicy& policy,
                      const std::vector<ObservationSet>& sets);

// Throws Error if the two lists of actions differ by more than kMostDifference.
void CheckAgreement(const Agreement& agreement);

}  // namespace shoal::launch

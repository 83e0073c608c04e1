// SPDX-License-Identifier: Apache-2.0
// From a checkpoint's policy to the bytes of an ONNX file that has been seen to act as it does.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/export/policy_actions.h"

namespace shoal::launch {

// The most by which an exported policy's actions may differ from ours in f32.
inline constexpr float kMostDifference = 1e-4f;

struct OnnxExport {
  std::string bytes;
  std::vector<Agreement> agreements;  // of each set of observations
};

// Writes the model, reads it back, and evaluates it by plain operators on each set. Throws Error
// saying by how much, where an action differs by more than kMostDifference.
OnnxExport ExportOnnx(const policy::CheckpointPolicy& policy,
                      const std::vector<ObservationSet>& sets);

// Throws Error where they do not agree.
void CheckAgreement(const Agreement& agreement);

}  // namespace shoal::launch

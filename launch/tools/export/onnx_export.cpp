// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_export.h"

#include "common/base/error.h"
#include "launch/tools/export/onnx_policy.h"

namespace shoal::launch {

OnnxExport ExportOnnx(const policy::CheckpointPolicy& policy,
                      const std::vector<ObservationSet>& sets) {
  OnnxExport result{.bytes = WriteOnnx(PolicyToOnnx(policy)), .agreements = {}};
  const OnnxModel model = ReadOnnx(result.bytes, "the ONNX model");
  for (const ObservationSet& set : sets) {
    const std::vector<float> ours = OwnActions(policy, set);
    const std::vector<float> theirs = OnnxActions(model, policy.description.spec, set);
    result.agreements.push_back(Compare(ours, theirs, set.count));
    CheckAgreement(result.agreements.back());
  }
  return result;
}

void CheckAgreement(const Agreement& agreement) {
  if (agreement.largest_difference <= kMostDifference) return;
  throw RuntimeError(
      "the ONNX model's actions differ from the policy's by up to {:.1e} on {} observations: "
      "expected at most {:.0e}; nothing was written",
      agreement.largest_difference, agreement.observations, kMostDifference);
}

}  // namespace shoal::launch

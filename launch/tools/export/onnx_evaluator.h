// SPDX-License-Identifier: Apache-2.0
// Runs an ONNX model by the plain operators of onnx_operators.h, node by node: slow, and simple
// enough to be believed. Export holds the policy against it before a file leaves.
#pragma once

#include <map>
#include <string>

#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

class OnnxEvaluator {
 public:
  // Throws Error where a node's operator is not known, reads what there is not, or writes what
  // there is already.
  explicit OnnxEvaluator(OnnxModel model);

  // The output (N, ...) of inputs (N, ...) by name; u8 as floats. Throws Error naming an input that
  // is missing or has another shape, and a node whose inputs do not fit.
  OnnxTensor Run(const std::map<std::string, OnnxTensor>& inputs) const;

 private:
  const OnnxModel model_;
};

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Runs an ONNX model node by node with the plain operators of onnx_operators.h. The evaluator is
// slow, but simple enough to serve as a reference. Export compares the policy with the evaluator
// before a file is written.
#pragma once

#include <map>
#include <string>

#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

class OnnxEvaluator {
 public:
  // Throws Error if a node has an unknown operator, reads a name that nothing defines, or writes a
  // name that is defined already.
  explicit OnnxEvaluator(OnnxModel model);

  // Computes the output (N, ...) from inputs (N, ...) by name; u8 inputs are passed as floats.
  // Throws Error naming an input that is missing or has a wrong shape, or a node whose inputs do
  // not match.
  OnnxTensor Run(const std::map<std::string, OnnxTensor>& inputs) const;

 private:
  const OnnxModel model_;
};

}  // namespace shoal::launch

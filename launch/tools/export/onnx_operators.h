// SPDX-License-Identifier: Apache-2.0
// The ONNX operators of exported policies, as plain loops. The operators share no code with the
// policy's networks, so that the check of a file is independent.
//
// Sums are in double. Attributes are supported only with the values that PolicyToOnnx writes.
#pragma once

#include <span>
#include <string_view>

#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

using OnnxArguments = std::span<const OnnxTensor* const>;
// Throws Error naming the node if its inputs or attributes do not match the operator.
using OnnxOperator = OnnxTensor (*)(const OnnxNode& node, OnnxArguments inputs);

// The operator of this name; null if there is none.
OnnxOperator FindOnnxOperator(std::string_view name);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// The operators of ONNX that an exported policy uses, as plain loops: what the file means, computed
// by none of the code that the policy is computed by.
//
// Sums are in double. Of attributes only the cases that PolicyToOnnx writes are there.
#pragma once

#include <span>
#include <string_view>

#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

using OnnxArguments = std::span<const OnnxTensor* const>;
// Throws Error naming the node where inputs or attributes are not what the operator takes.
using OnnxOperator = OnnxTensor (*)(const OnnxNode& node, OnnxArguments inputs);

// Null: none of that name.
OnnxOperator FindOnnxOperator(std::string_view name);

}  // namespace shoal::launch

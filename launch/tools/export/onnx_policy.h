// SPDX-License-Identifier: Apache-2.0
// A policy as an ONNX model: an actor's computation from raw pixels and vectors to the action
// without exploration.
//
//   pixels            u8  (N, K*C, H, W)   only with pixels
//   NAME of a block   f32 (N, size)        each block that the policy sees, in the spec's order
//   action            f32 (N, A)           in [-1, 1]
//
// The model pools and scales pixels, and normalises vectors if the policy was trained on normalised
// vectors. Batch normalisation uses running statistics. The model has no random shifts, which
// belong to training, and no Gaussian deviation, which belongs to exploration.
#pragma once

#include "common/policy/checkpoint_policy.h"
#include "launch/tools/export/onnx_model.h"

namespace shoal::launch {

inline constexpr char kPixelsInput[] = "pixels", kActionOutput[] = "action";

// Throws Error naming a tensor that is missing or of a wrong type or shape, or a block whose name
// is used already.
OnnxModel PolicyToOnnx(const policy::CheckpointPolicy& policy);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// The file of network.encoder_weights: safetensors that an encoder starts from.
//
// Tensors have Shoal's names, encoder.NAME, as in a checkpoint's policy.safetensors. If no name in
// the file begins like that, NAME alone is used, which for resnet18 and alexnet is torchvision's.
// Tensors of no encoder are ignored: other networks of a policy, and torchvision's fc.*,
// classifier.* and *.num_batches_tracked.
#pragma once

#include "common/config/config.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// The encoder's tensors, F32, as encoder.NAME; empty where the key is. Throws Error (kUsage) naming
// the file and a tensor that is missing, of another shape or type, not finite or none of this
// encoder's.
TensorMap ReadEncoderWeights(const NetworkConfig& network, const ObservationSpec& spec);

}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
// What network.encoder_weights names: a safetensors file that an encoder starts from.
//
// Tensors are looked for under Shoal's names, encoder.NAME, as in a checkpoint's
// policy.safetensors; where the file has none that begin like that, under NAME alone, which for
// resnet18 and alexnet is torchvision's. What belongs to no encoder is left alone: other networks
// of a policy, and torchvision's fc.*, classifier.* and *.num_batches_tracked.
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

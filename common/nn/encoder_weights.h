// SPDX-License-Identifier: Apache-2.0
// Reads the file of network.encoder_weights: a safetensors file with an encoder's initial weights.
//
// Tensors have Shoal's names, encoder.NAME, as in a checkpoint's policy.safetensors. If no name in
// the file begins with "encoder.", NAME alone is used; for resnet18 and alexnet, NAME is
// torchvision's. Tensors outside of the encoder are ignored: other networks of a policy, and
// torchvision's fc.*, classifier.* and *.num_batches_tracked.
#pragma once

#include "common/config/config.h"
#include "common/nn/safetensors.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Returns the encoder's tensors, F32, named encoder.NAME; empty if the key is empty. Throws Error
// (kUsage) that names the file and the tensor if a tensor is missing, has a wrong shape or type, is
// not finite or does not belong to this encoder.
TensorMap ReadEncoderWeights(const NetworkConfig& network, const ObservationSpec& spec);

}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
// Products and convolutions of HostDevice: plain loops over host memory. Inputs in bf16 are widened
// exactly, sums are f32, and results are rounded once.
#pragma once

#include "learner/device/commands.h"

namespace shoal::learner::device {

// The commands of the same names; formulas and shapes are in commands.h.
void ComputeProduct(const Product& product);
void ComputeForward(const ConvolutionForward& convolution);
void ComputeData(const ConvolutionData& convolution);
void ComputeWeights(const ConvolutionWeights& convolution);

}  // namespace shoal::learner::device

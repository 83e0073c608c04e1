// SPDX-License-Identifier: Apache-2.0
// Elementwise operations on whole maps of the same layout, f32 or bf16. If a layout has padding,
// its zeros stay zero. NaN stays NaN. The work is split over the threads of the current
// ThreadScope.
#pragma once

#include "common/nn/op.h"

namespace shoal::nn {

// y = max(y, 0)
void Relu(const dnnl::memory& y);
// y += x
void Add(const dnnl::memory& x, const dnnl::memory& y);
// y = max(y + x, 0)
void AddThenRelu(const dnnl::memory& x, const dnnl::memory& y);
// Sets dy to 0 except where y > 0. This is the backward pass of a ReLU with the output y.
void MaskWhereZero(const dnnl::memory& y, const dnnl::memory& dy);

}  // namespace shoal::nn

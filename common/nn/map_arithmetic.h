// SPDX-License-Identifier: Apache-2.0
// Elementwise operations on whole maps of one layout, f32 or bf16. Padding zeros of a layout stay
// zero. NaN stays NaN. The work is split over the current ThreadScope.
#pragma once

#include "common/nn/op.h"

namespace shoal::nn {

// y = max(y, 0)
void Relu(const dnnl::memory& y);
// y += x
void Add(const dnnl::memory& x, const dnnl::memory& y);
// y = max(y + x, 0)
void AddThenRelu(const dnnl::memory& x, const dnnl::memory& y);
// dy = 0 where y is not above 0: the gradient of a ReLU whose output is y.
void MaskWhereZero(const dnnl::memory& y, const dnnl::memory& dy);

}  // namespace shoal::nn

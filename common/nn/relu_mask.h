// SPDX-License-Identifier: Apache-2.0
// Backward pass of a ReLU over arrays of any layout: dx = dy where y > 0, else 0, in place.
#pragma once

#include <cstdint>

namespace shoal::nn {

// y, dy: n values in the same order. Splits the work over the current ThreadScope.
void MaskWhereZero(const float* y, int64_t n, float* dy);
// Does the same for bf16.
void MaskWhereZero(const uint16_t* y, int64_t n, uint16_t* dy);

}  // namespace shoal::nn

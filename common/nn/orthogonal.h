// SPDX-License-Identifier: Apache-2.0
// Orthogonal initialisation.
//
//   Q R = G,  G (m, n) ~ N(0, 1),  W = gain * Q diag(sign R)
//
// Q R is the QR decomposition of G. W / gain is distributed uniformly over the matrices with
// orthonormal columns (orthonormal rows if W has more columns than rows).
// Source: Saxe et al. 2013, arXiv:1312.6120; signs: Mezzadri 2006, arXiv:math-ph/0609050.
#pragma once

#include <cstdint>

#include "common/base/random.h"

namespace shoal::nn {

// Fills weights (rows, cols), row-major.
void FillOrthogonal(int64_t rows, int64_t cols, double gain, Random* random, float* weights);

}  // namespace shoal::nn

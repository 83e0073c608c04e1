// SPDX-License-Identifier: Apache-2.0
// Mean and variance of all vectors so far, updated batch by batch.
//
// The moments of vectors of V numbers are 1 + 2V numbers: the count of vectors, their mean (V), and
// the sums of squared distances from it (V). Zeros before any vector.
// Source: Chan et al. 1983, "Algorithms for computing the sample variance".
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace shoal::learner {

constexpr size_t MomentsSize(size_t width) { return 1 + 2 * width; }

// rows (N, V).
void AddToMoments(std::span<const float> rows, std::span<double> moments);

// (V) f32: 0 and 1 before any vector.
std::vector<float> MeanOf(std::span<const double> moments);
// Variances below the floor become the floor.
std::vector<float> VarianceOf(std::span<const double> moments, float floor = 0);

}  // namespace shoal::learner

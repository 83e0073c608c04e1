// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/moments.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::learner {

void AddToMoments(std::span<const float> rows, std::span<double> moments) {
  const size_t width = moments.size() / 2;
  if (width == 0) return;
  CHECK(rows.size() % width == 0) << rows.size();
  const size_t n = rows.size() / width;
  if (n == 0) return;
  double& count = moments[0];
  const auto added = double(n);
  for (size_t j = 0; j < width; ++j) {
    double mean = 0, squares = 0;
    for (size_t i = 0; i < n; ++i) mean += double{rows[i * width + j]} / added;
    for (size_t i = 0; i < n; ++i) {
      const double distance = double{rows[i * width + j]} - mean;
      squares += distance * distance;
    }
    double& former = moments[1 + j];
    const double apart = mean - former, total = count + added;
    moments[1 + width + j] += squares + apart * apart * count * added / total;
    former += apart * added / total;
  }
  count += added;
}

std::vector<float> MeanOf(std::span<const double> moments) {
  const auto mean = moments.subspan(1, moments.size() / 2);
  return {mean.begin(), mean.end()};
}

std::vector<float> VarianceOf(std::span<const double> moments, float floor) {
  const auto squares = moments.last(moments.size() / 2);
  const double count = moments[0];
  std::vector<float> variance(squares.size(), 1.f);
  if (count > 0) {
    std::ranges::transform(squares, variance.begin(), [&](double s) { return float(s / count); });
  }
  for (float& v : variance) v = std::max(v, floor);
  return variance;
}

}  // namespace shoal::learner

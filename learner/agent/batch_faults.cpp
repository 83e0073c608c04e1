#include "learner/agent/batch_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shoal::learner {
namespace {

bool AllFinite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

bool AllFinite(const BatchView& batch) {
  return AllFinite(std::span<const float>(batch.obs_vector)) &&
         AllFinite(std::span<const float>(batch.next_obs_vector)) &&
         AllFinite(std::span<const float>(batch.obs_privileged)) &&
         AllFinite(std::span<const float>(batch.next_obs_privileged)) &&
         AllFinite(std::span<const float>(batch.action)) &&
         AllFinite(std::span<const float>(batch.reward)) &&
         AllFinite(std::span<const float>(batch.bootstrap));
}

bool Usable(float loss, double gradient_squares) {
  return std::isfinite(loss) && gradient_squares < std::numeric_limits<float>::max();
}

}  // namespace shoal::learner

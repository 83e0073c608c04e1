// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/priority_scale.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::replay {
namespace {

constexpr int kExponentBits = 20;
constexpr double kLeastPriority = 1e-6;  // of a proportional priority, so that no sample is lost

// base^(exponent 2^-20): the product of the roots base^(2^-k) for the bits of the exponent.
double Power(double base, uint32_t exponent) {
  if (exponent == 1u << kExponentBits) return base;
  double product = 1, root = base;
  for (int bit = kExponentBits - 1; bit >= 0; --bit) {
    root = std::sqrt(root);
    if ((exponent >> bit & 1u) != 0) product *= root;
  }
  return product;
}

}  // namespace

PriorityScale::PriorityScale(PriorityKind kind, double exponent)
    : kind_(kind), exponent_(static_cast<uint32_t>(std::lround(exponent * (1u << kExponentBits)))) {
  CHECK(exponent >= 0 && exponent <= 1) << exponent;
}

uint64_t PriorityScale::WeightOf(float error) const {
  CHECK(std::isfinite(error) && error >= 0) << error;
  const double priority =
      kind_ == PriorityKind::kLap ? std::max(double{error}, 1.0) : double{error} + kLeastPriority;
  const double weight = std::round(Power(priority, exponent_) * static_cast<double>(kOne));
  return static_cast<uint64_t>(std::clamp(weight, 1.0, static_cast<double>(kMost)));
}

}  // namespace shoal::replay

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/site_motion.h"

#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <vector>

namespace shoal::worlds {
namespace {

// Sums from the first joint on, in the order used for the recorded trajectories. The engine's own
// product differs in the last bit.
double Dot(const double* a, const double* b, int size) {
  double sum = 0;
  for (int i = 0; i < size; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

SiteVelocity VelocityOfSite(const World& world, int site) {
  const mjModel& model = world.model();
  const mjData& data = world.data();
  const auto size = 3 * static_cast<size_t>(model.nv);
  std::vector<double> linear(size), angular(size);
  mj_jacSite(&model, &data, linear.data(), angular.data(), site);
  SiteVelocity velocity;
  for (size_t axis = 0; axis < 3; ++axis) {
    velocity.linear[axis] = Dot(linear.data() + axis * size / 3, data.qvel, model.nv);
    velocity.angular[axis] = Dot(angular.data() + axis * size / 3, data.qvel, model.nv);
  }
  return velocity;
}

std::array<double, 3> PositionOfSite(const World& world, int site) {
  const double* position = world.data().site_xpos + 3 * site;
  return {position[0], position[1], position[2]};
}

std::array<double, 3> EulerAngles(const double* rotation) {
  const auto r = [rotation](int row, int column) { return rotation[3 * row + column]; };
  const double cosine = std::sqrt(r(2, 2) * r(2, 2) + r(1, 2) * r(1, 2));
  const double y = -std::atan2(-r(0, 2), cosine);
  if (cosine > 4 * std::numeric_limits<double>::epsilon()) {
    return {-std::atan2(r(1, 2), r(2, 2)), y, -std::atan2(r(0, 1), r(0, 0))};
  }
  return {0, y, -std::atan2(-r(1, 0), r(1, 1))};
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// How a site moves and how it is turned.
#pragma once

#include <array>

#include "actor/worlds/world.h"

namespace shoal::worlds {

// Velocities in the world's frame, m/s and rad/s: the Jacobian of the last kinematics times the
// current joint velocities, whatever engine calls came between.
struct SiteVelocity {
  std::array<double, 3> linear{}, angular{};
};
SiteVelocity VelocityOfSite(const World& world, int site);

// Position in m, as of the last kinematics.
std::array<double, 3> PositionOfSite(const World& world, int site);

// Euler angles (x, y, z) in rad of a row-major rotation matrix, as Gymnasium-Robotics' observations
// have them: a turn by a about one axis alone gives a in that component and 0 in the others. At a
// pitch of +-90 degrees, where x and z turn about the same axis, x is 0.
std::array<double, 3> EulerAngles(const double* rotation);

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Velocity, position and orientation of a site.
#pragma once

#include <array>

#include "actor/worlds/world.h"

namespace shoal::worlds {

// Velocities in the world's frame, m/s and rad/s: the Jacobian of the last kinematics times the
// current joint velocities, even if the joint velocities are newer than the kinematics.
struct SiteVelocity {
  std::array<double, 3> linear{}, angular{};
};
SiteVelocity VelocityOfSite(const World& world, int site);

// Position of a site in m at the last kinematics.
std::array<double, 3> PositionOfSite(const World& world, int site);

// Euler angles (x, y, z) in rad of a row-major rotation matrix, as in Gymnasium-Robotics'
// observations: a rotation by angle a about one axis gives a in that component and 0 in the others.
// At a pitch of +-90 degrees, where x and z rotate about the same axis, x is 0.
std::array<double, 3> EulerAngles(const double* rotation);

}  // namespace shoal::worlds

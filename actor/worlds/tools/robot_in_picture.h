// SPDX-License-Identifier: Apache-2.0
// Is the robot in the picture, or does a broken renderer draw an empty one? Draws the same scene
// with the robot's geoms and without them and compares.
#pragma once

#include <string>

#include "actor/worlds/tools/render_task.h"
#include "actor/worlds/world.h"
#include "common/config/config.h"

namespace shoal::worlds {

// Share of the pixels that differ. CHECK on pictures of different size.
double ChangedShare(const Picture& a, const Picture& b);

// Share of a camera's pixels that show the robot, 0..1: those that change when the geoms of all
// bodies whose name starts with `prefix` become transparent. The world is as before afterwards.
// Throws Error when there is no such camera, no such body, or no rendering.
double RobotShare(World* world, const std::string& prefix, const std::string& camera,
                  const ObservationConfig& observation);

}  // namespace shoal::worlds

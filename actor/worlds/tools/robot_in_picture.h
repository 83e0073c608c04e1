// SPDX-License-Identifier: Apache-2.0
// Check that pictures show the robot, to detect a broken renderer. Compares pictures of the same
// scene with and without the robot's geoms.
#pragma once

#include <string>

#include "actor/worlds/tools/render_task.h"
#include "actor/worlds/world.h"
#include "common/config/config.h"

namespace shoal::worlds {

// Share of the pixels that differ, 0..1. CHECK: the pictures have the same size.
double ChangedShare(const Picture& a, const Picture& b);

// Share of a camera's pixels that show the robot, 0..1: the pixels that change when the geoms of
// all bodies whose name starts with `prefix` become transparent. Restores the world. Throws Error
// if there is no such camera or body, or if rendering is not available.
double RobotShare(World* world, const std::string& prefix, const std::string& camera,
                  const ObservationConfig& observation);

}  // namespace shoal::worlds

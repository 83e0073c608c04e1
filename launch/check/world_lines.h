// SPDX-License-Identifier: Apache-2.0
// Rendering and physics.
#pragma once

#include "common/config/config.h"
#include "launch/check/check_line.h"

namespace shoal::launch {

// `share`: of the camera's pixels that show the robot, 0..1.
CheckLine JudgePicture(const std::string& camera, double share);

// Draws each of the configuration's cameras at its size: the first that fails, or how much of each
// picture is robot. For tasks of the Fetch robot. Throws Error when nothing can be drawn.
CheckLine LookAtPictures(const Config& config);

// LookAtPictures in quality fast, which needs OSMesa. Warns where LookAtPictures fails: runs in
// quality native do without OSMesa.
CheckLine LookAtOpenGl(Config config);

// Replays the embedded reference; throws Error when that cannot be done.
CheckLine LookAtPhysics();

}  // namespace shoal::launch

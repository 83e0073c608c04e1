// SPDX-License-Identifier: Apache-2.0
// Lines of `shoal check` about rendering and physics.
#pragma once

#include "common/config/config.h"
#include "launch/check/check_line.h"

namespace shoal::launch {

// `share`: share of the camera's pixels that show the robot, 0..1.
CheckLine JudgePicture(const std::string& camera, double share);

// Draws a picture with each of the configuration's cameras, in the size of frames. Reports the
// first camera that fails, or the share of robot pixels in each picture. Only for tasks of the
// Fetch robot. Throws Error if drawing is impossible.
CheckLine LookAtPictures(const Config& config);

// Like LookAtPictures in quality fast, which needs OSMesa. Returns WARN where LookAtPictures
// returns FAIL, because runs in quality native do not need OSMesa.
CheckLine LookAtOpenGl(Config config);

// Replays the embedded reference. Throws Error if the replay is impossible.
CheckLine LookAtPhysics();

}  // namespace shoal::launch

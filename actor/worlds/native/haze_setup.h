// SPDX-License-Identifier: Apache-2.0
// Set-up of a scene's haze for the kernels.
#pragma once

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/frame_job.h"

struct mjModel_;
struct mjvScene_;

namespace shoal::worlds::native {

// A model's haze, from visual/map and visual/rgba.
struct HazeStyle {
  float width = 0;           // 0 = none
  float rgb[3] = {0, 0, 0};  // 0..255

  HazeStyle() = default;
  explicit HazeStyle(const mjModel_& model);
};

// Fills `haze` from the scene's first endless plane. False if there is no such plane. The haze is
// not visible from below the plane, if the scene's flags turn the haze off, or if the style has
// none. The engine draws haze only in front of a sky.
bool MakeHaze(const mjvScene_& scene, const CameraFrame& frame, const HazeStyle& style, Haze* haze);

}  // namespace shoal::worlds::native

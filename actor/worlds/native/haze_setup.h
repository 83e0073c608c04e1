// SPDX-License-Identifier: Apache-2.0
// The haze of a scene, for the kernels.
#pragma once

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/frame_job.h"

struct mjModel_;
struct mjvScene_;

namespace shoal::worlds::native {

// A model's haze, as it is set in visual/map and visual/rgba.
struct HazeStyle {
  float width = 0;           // 0 = none
  float rgb[3] = {0, 0, 0};  // 0..255

  HazeStyle() = default;
  explicit HazeStyle(const mjModel_& model);
};

// Fills `haze` by the scene's first endless plane. False: there is none. The haze is not seen from
// below the plane, where the scene's flags turn it off, and where the style has none. The engine
// draws it only before a sky.
bool MakeHaze(const mjvScene_& scene, const CameraFrame& frame, const HazeStyle& style, Haze* haze);

}  // namespace shoal::worlds::native

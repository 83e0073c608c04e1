// SPDX-License-Identifier: Apache-2.0
// Rendering of one picture of a task, for people.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "actor/worlds/painter.h"

namespace shoal::worlds {

// (H, W, 3) uint8, row 0 = top, interleaved RGB: the format of image::WritePng.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> pixels;
  std::string camera = "";  // name of the camera; empty = unknown
};

struct RenderRequest {
  std::string task;    // "FetchReachDense"
  std::string camera;  // "front"; empty = the task's first camera
  int width = 480, height = 480;
  std::string quality = "reference";               // fast | native | reference
  PainterOutput output = PainterOutput::kColours;  // other outputs: only in quality native
  bool goal = false;  // true: draws the goal picture of observation.goal_mode = image
  int env_steps = 0;  // number of random steps before the picture, at most an episode's length
  int64_t seed = 1;   // of the goal and of the actions
  std::string model;  // path of another MJCF file; empty = the built-in model
};

// Draws the picture. Throws Error (kUsage) on an unknown task, camera or quality, an output that
// the quality does not have, a size that is not 1..4096, more env steps than an episode has, a goal
// picture of a task without goal pictures, or a goal picture after steps. Throws Error (kRuntime)
// if the task terminates the episode earlier.
Picture RenderTask(const RenderRequest& request);

}  // namespace shoal::worlds

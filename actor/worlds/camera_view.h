// SPDX-License-Identifier: Apache-2.0
// Cameras of a task as configuration data: views of the engine's free camera, and cameras of the
// model.
#pragma once

#include <array>
#include <string>

namespace shoal::worlds {

// A free view looks at `lookat` from `distance`. Azimuth 0 looks along +x, 90 along +y; negative
// elevation looks down. The vertical field of view is that of the model (45 degrees by default).
//
// If `body` is set, the view is mounted on that body and moves with the body. The numbers are then
// in the body's frame, whose origin is the body's position.
//
// If `model_camera` is set, the view is a camera of the model, which may follow a body. The numbers
// of the free view are then ignored.
struct CameraView {
  std::string name;
  std::array<double, 3> lookat{};  // m
  double distance = 0;             // m
  double azimuth_degrees = 0;
  double elevation_degrees = 0;
  std::string body = {};  // of a mounted view; empty = the world
  int model_camera = -1;  // number of the camera in the model; -1 = a free view
};

}  // namespace shoal::worlds

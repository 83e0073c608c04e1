// Cameras of a task as configuration data: views of the engine's free camera.
#pragma once

#include <array>
#include <string>

namespace shoal::worlds {

// The camera looks at `lookat` from `distance`; azimuth 0 looks along +x, 90 along +y; negative
// elevation looks down. The vertical field of view is the model's (45 degrees by default).
struct CameraView {
  std::string name;
  std::array<double, 3> lookat;  // m
  double distance;               // m
  double azimuth_degrees;
  double elevation_degrees;
};

}  // namespace shoal::worlds

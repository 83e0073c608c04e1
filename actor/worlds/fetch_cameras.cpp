#include "actor/worlds/fetch_cameras.h"

namespace shoal::worlds {

std::span<const CameraView> FetchCameras() {
  static const CameraView cameras[] = {
      {"front", {1.34, 0.75, 0.53}, 0.75, 180, -30},
      {"side", {1.34, 0.75, 0.53}, 0.75, 90, -30},
      {"close", {1.34, 0.75, 0.53}, 1.1, 132, -35},
      {"gymnasium", {1.3, 0.75, 0.55}, 2.5, 132, -14},
  };
  return cameras;
}

}  // namespace shoal::worlds

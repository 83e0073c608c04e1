// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_cameras.h"

namespace shoal::worlds {
namespace {

// The camera of Gymnasium-Robotics.
CameraView Gymnasium() { return {"gymnasium", {1.3, 0.75, 0.55}, 2.5, 132, -14}; }

// Mounted on the gripper, whose x axis points from the wrist to the fingers. Looks at the fingers
// from above and from outside.
CameraView Wrist() { return {"wrist", {0.1, 0, 0.06}, 0.4, 0, -45, "robot0:gripper_link"}; }

}  // namespace

std::span<const CameraView> FetchCameras() {
  static const CameraView cameras[] = {
      {"front", {1.34, 0.75, 0.53}, 0.75, 180, -30},
      {"side", {1.34, 0.75, 0.53}, 0.75, 90, -30},
      {"close", {1.34, 0.75, 0.53}, 1.1, 132, -35},
      Gymnasium(),
      Wrist(),
  };
  return cameras;
}

std::span<const CameraView> FetchPickAndPlaceCameras() {
  static const CameraView cameras[] = {
      {"front", {1.34, 0.75, 0.6}, 1.05, 180, -20},
      {"side", {1.34, 0.75, 0.6}, 1.05, 90, -20},
      {"close", {1.34, 0.75, 0.6}, 1.2, 132, -35},
      Gymnasium(),
      Wrist(),
  };
  return cameras;
}

std::span<const CameraView> FetchSlideCameras() {
  static const CameraView cameras[] = {
      {"front", {1.3, 0.75, 0.42}, 1.3, 180, -35},
      {"side", {1.32, 0.75, 0.42}, 1.3, 90, -35},
      {"close", {1.34, 0.75, 0.42}, 1.5, 132, -35},
      Gymnasium(),
      Wrist(),
  };
  return cameras;
}

const CameraView& FetchPushFilmCamera() {
  static const CameraView camera{"film", {1.34, 0.75, 0.44}, 0.95, 115, -55};
  return camera;
}

const CameraView& FetchPickAndPlaceFilmCamera() {
  static const CameraView camera{"film", {1.34, 0.75, 0.58}, 1.3, 125, -30};
  return camera;
}

const CameraView& FetchSlideFilmCamera() {
  static const CameraView camera{"film", {1.25, 0.75, 0.42}, 1.6, 155, -48};
  return camera;
}

}  // namespace shoal::worlds

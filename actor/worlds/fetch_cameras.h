// Cameras of the Fetch tasks.
#pragma once

#include <span>

#include "actor/worlds/camera_view.h"

namespace shoal::worlds {

// gymnasium: the view of the published environments, in which the target is under two pixels wide
// at 84x84. front, side, close: near the space the gripper moves in.
std::span<const CameraView> FetchCameras();

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Cameras of the Fetch tasks.
#pragma once

#include <span>

#include "actor/worlds/camera_view.h"

namespace shoal::worlds {

// gymnasium: the view of the published environments, in which the target is under two pixels wide
// at 84x84. front, side, close: near the space that gripper, object and goal move in: a cube for
// Reach and Push, twice as high for PickAndPlace, most of the long table for Slide. wrist: moves
// with the gripper and looks at what is below it.
std::span<const CameraView> FetchCameras();
std::span<const CameraView> FetchPickAndPlaceCameras();
std::span<const CameraView> FetchSlideCameras();

// Larger views for films: from high at the side, where gripper and arm seldom hide object or goal.
const CameraView& FetchPushFilmCamera();
const CameraView& FetchPickAndPlaceFilmCamera();
const CameraView& FetchSlideFilmCamera();

}  // namespace shoal::worlds

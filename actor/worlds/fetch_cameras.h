// SPDX-License-Identifier: Apache-2.0
// Cameras of the Fetch tasks.
#pragma once

#include <span>

#include "actor/worlds/camera_view.h"

namespace shoal::worlds {

// gymnasium: the view of the published environments; at 84x84 the target is less than two pixels
// wide. front, side, close: views of the space in which gripper, object and goal move (a cube for
// Reach and Push, twice as high for PickAndPlace, most of the long table for Slide). wrist: moves
// with the gripper and looks down.
std::span<const CameraView> FetchCameras();
std::span<const CameraView> FetchPickAndPlaceCameras();
std::span<const CameraView> FetchSlideCameras();

// Cameras for films. They look down from the side, so that gripper and arm seldom hide the object
// or the goal.
const CameraView& FetchPushFilmCamera();
const CameraView& FetchPickAndPlaceFilmCamera();
const CameraView& FetchSlideFilmCamera();

}  // namespace shoal::worlds

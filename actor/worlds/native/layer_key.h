// SPDX-License-Identifier: Apache-2.0
// Key of a picture of geoms that do not move: everything that the picture depends on except the
// model.
#pragma once

#include <span>

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/static_layers.h"

struct mjvScene_;

namespace shoal::worlds::native {

// Writes the camera, the size of the view, the lights and the geoms with numbers `fixed` to `key`,
// which keeps its memory.
void MakeLayerKey(const mjvScene_& scene, const CameraFrame& frame, const View& view,
                  std::span<const int> fixed, StaticLayers::Key* key);

}  // namespace shoal::worlds::native

// SPDX-License-Identifier: Apache-2.0
// The visible geoms of a scene in the order in which they are drawn.
#pragma once

#include <vector>

#include "actor/worlds/native/camera_frame.h"

struct mjvScene_;

namespace shoal::worlds::native {

// Numbers in scene.geoms. The vectors keep their memory from frame to frame.
struct DrawingOrder {
  std::vector<int> fixed;        // opaque, and of a body that never moves
  std::vector<int> moving;       // opaque
  std::vector<int> transparent;  // nearest first, as the engine sorts them

  // Throws Error (kNonFinite) on a geom that is not finite, (kRuntime) on one that cannot be drawn.
  void Sort(const mjvScene_& scene, const CameraFrame& frame);

 private:
  std::vector<double> distances_;  // of transparent geoms, by number
};

}  // namespace shoal::worlds::native

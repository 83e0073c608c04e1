// SPDX-License-Identifier: Apache-2.0
// Cylinders and capsules with few triangles. They replace the engine's cylinders and capsules.
//
// The engine divides every side along its axis and every cap along its radius, as finely as a
// sphere from pole to pole. At 84x84 these divisions are invisible, but they cause most of the cost
// of drawing a robot of such shapes. Here sides are not divided, flat caps have no centre vertex,
// and a capsule is one object instead of three.
#pragma once

#include <cstdint>
#include <map>

struct mjvScene_;
struct mjrContext_;

namespace shoal::worlds {

// Belongs to the OpenGL context that is current at the first use; its display lists end with that
// context. One thread.
class LowPolyShapes {
 public:
  // `slices`: number of slices around the axis, at least 3.
  explicit LowPolyShapes(int slices);

  // Turns the scene's cylinders and capsules without texture, of circular cross-section, into
  // meshes that `context` draws, with the same place, size and colour. Other geoms do not change.
  void Replace(const mjrContext_& context, mjvScene_* scene);

 private:
  uint32_t Cylinder();
  uint32_t Capsule(float half_length);

  int slices_;
  // Names of display lists of shapes along z with radius 1.
  uint32_t cylinder_ = 0;  // from z = -1 to 1
  // Keyed by half the distance between the centres of the caps.
  std::map<float, uint32_t> capsules_;
};

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Cylinders and capsules of few triangles, for the engine to draw in place of its own.
//
// The engine divides every side along its axis and every cap along its radius, as finely as a
// sphere from pole to pole. At 84x84 these divisions are invisible, and they are most of the cost
// of a robot of such shapes. Here sides are not divided, flat caps have no centre, and a capsule is
// one object instead of three.
#pragma once

#include <cstdint>
#include <map>

struct mjvScene_;
struct mjrContext_;

namespace shoal::worlds {

// Belongs to the OpenGL context that is current when it is used first, and goes with it. One
// thread.
class LowPolyShapes {
 public:
  // slices: around the axis; at least 3.
  explicit LowPolyShapes(int slices);

  // Turns the scene's cylinders and capsules without texture, of circular cross-section, into
  // meshes that `context` draws: same place, size and colour. Others stay.
  void Replace(const mjrContext_& context, mjvScene_* scene);

 private:
  uint32_t Cylinder();
  uint32_t Capsule(float half_length);

  int slices_;
  // Names of display lists of shapes along z with radius 1.
  uint32_t cylinder_ = 0;  // from z = -1 to 1
  // By half the length between the centres of the caps.
  std::map<float, uint32_t> capsules_;
};

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Normals and texture coordinates of meshes. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/light_kernels.h"

namespace {

using namespace shoal::worlds::native;

struct MeshPoint {
  Vector normal;
  F turn_x, turn_y;  // change of depth on the plane of the triangle
  Footprint coords;  // texture coordinates, if the mesh has them
};

// Interpolates between the corners of each lane's triangle.
SHOAL_INLINE MeshPoint MeshAt(const View& view, const Surface& s, M lanes, I numbers, F ray_x,
                              F ray_y, F depth) {
  alignas(64) int32_t stored[kLanes];
  Store(stored, numbers);
  const F zero = Set(0.0f);
  MeshPoint point{{zero, zero, zero}, zero, zero, {}};
  Vector object{zero, zero, zero};
  F coords[6] = {zero, zero, zero, zero, zero, zero};
  for (M left = lanes; Any(left);) {
    const int number = stored[FirstLane(left)];
    const M here = left & (numbers == Set(int32_t{number}));
    left = Without(left, here);
    const Triangle& triangle = s.mesh.triangles[number];
    const float* n = s.mesh.normals + 9 * int64_t{triangle.index};
    const F x = ray_x - Set(triangle.x), y = ray_y - Set(triangle.y);
    F b[3];
    for (int k = 0; k < 3; ++k) {
      const Affine& edge = triangle.edges[k];
      b[k] = (Set(edge.c) + Set(edge.x) * x + Set(edge.y) * y) * depth;
    }
    const auto mix = [&b](const float* corner, int stride) {
      return b[0] * Set(corner[0]) + b[1] * Set(corner[stride]) + b[2] * Set(corner[2 * stride]);
    };
    object.x = Select(here, mix(n, 3), object.x);
    object.y = Select(here, mix(n + 1, 3), object.y);
    object.z = Select(here, mix(n + 2, 3), object.z);
    point.turn_x = Select(here, Set(triangle.w.x) * depth, point.turn_x);
    point.turn_y = Select(here, Set(triangle.w.y) * depth, point.turn_y);
    if (s.mesh.coords == nullptr) continue;
    const float* c = s.mesh.coords + 6 * int64_t{triangle.index};
    for (int k = 0; k < 2; ++k) {
      const F at = mix(c + k, 2);
      float along_x = 0, along_y = 0;
      for (int corner = 0; corner < 3; ++corner) {
        along_x += triangle.edges[corner].x * c[2 * corner + k];
        along_y += triangle.edges[corner].y * c[2 * corner + k];
      }
      coords[k] = Select(here, at, coords[k]);
      const F pixel = depth * Set(view.pixel);
      coords[2 + k] = Select(here, (Set(along_x) - at * Set(triangle.w.x)) * pixel, coords[2 + k]);
      coords[4 + k] = Select(here, (Set(along_y) - at * Set(triangle.w.y)) * pixel, coords[4 + k]);
    }
  }
  const float(*axes)[3] = s.mesh.axes;
  F* to[3] = {&point.normal.x, &point.normal.y, &point.normal.z};
  for (int k = 0; k < 3; ++k) {
    *to[k] = Set(axes[0][k]) * object.x + Set(axes[1][k]) * object.y + Set(axes[2][k]) * object.z;
  }
  const F length = Max(Sqrt(Dot(point.normal, point.normal)), Set(1e-20f));
  point.normal = Scale(Set(1.0f) / length, point.normal);
  point.coords = {
      {coords[0], coords[1], zero}, {coords[2], coords[3], zero}, {coords[4], coords[5], zero}};
  return point;
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// Light of planes at the vertices of their grids. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lane_gathers.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/light_kernels.h"

namespace {

using namespace shoal::worlds::native;

// Lights the vertices of one block of a grid.
inline void LightBlock(const LightSet& lights, const Surface& s, int row, int block) {
  PlaneGrid& grid = *s.grid;
  const float y = grid.y[row];
  const float* ey = s.grid_directions[1];
  const Vector normal = Set(s.normal), from = Set(s.centre), along = Set(s.grid_directions[0]);
  for (int i = block * kTilePixels; i < (block + 1) * kTilePixels; i += kLanes) {
    const F x = Load(grid.x + i);
    const Vector p{from.x + along.x * x + Set(ey[0] * y), from.y + along.y * x + Set(ey[1] * y),
                   from.z + along.z * x + Set(ey[2] * y)};
    Vector to_eye = p;
    if (s.specular) to_eye = Scale(Set(-1.0f) / Max(Sqrt(Dot(p, p)), Set(1e-20f)), p);
    const int at = row * grid.stride + i;
    if (s.grey_grid) {
      Store(grid.light[0] + at, LightAt<true>(lights, s, p, normal, to_eye).r);
      continue;
    }
    const Colour colour = LightAt<false>(lights, s, p, normal, to_eye);
    Store(grid.light[0] + at, colour.r);
    Store(grid.light[1] + at, colour.g);
    Store(grid.light[2] + at, colour.b);
  }
}

SHOAL_INLINE void NeedVertex(const LightSet& lights, const Surface& s, int vertex_x, int vertex_y) {
  const int block = vertex_x >> kTilePixelsLog2;
  uint32_t& stamp = s.grid->stamps[vertex_y * (s.grid->stride >> kTilePixelsLog2) + block];
  if (stamp == s.stamp) return;
  stamp = s.stamp;
  LightBlock(lights, s, vertex_y, block);
}

struct GridCell {
  I index;
  F fraction;
};

SHOAL_INLINE GridCell FindCell(const PlaneGrid& grid, int axis, F at) {
  const F zero = Set(0.0f), start = Set(grid.start[axis]), step = Set(grid.step[axis]);
  const F last = Set(static_cast<float>(grid.cells[axis] - 1));
  const F cell = (at - start) * Set(grid.inverse_step[axis]) + Set(1.0f);
  const I index = Truncate(Min(Max(cell, zero), last));
  const F number = ToFloat(index);
  const M first = Set(int32_t{1}) > index;
  const M edge = first | (index == Set(int32_t{grid.cells[axis] - 1}));
  const F left = Select(first, start - Set(grid.pad[axis]), start + (number - Set(1.0f)) * step);
  const F inverse = Select(edge, Set(grid.inverse_pad[axis]), Set(grid.inverse_step[axis]));
  return {index, Min(Max((at - left) * inverse, zero), Set(1.0f))};
}

// Computes the light at the corners of the cells of all lanes in `lanes`. Returns true if all lanes
// share one cell.
SHOAL_INLINE bool NeedCells(const LightSet& lights, const Surface& s, M lanes, I x, I y, I cell) {
  alignas(64) int32_t cells[kLanes], xs[kLanes], ys[kLanes];
  Store(cells, cell);
  Store(xs, x);
  Store(ys, y);
  int found = 0;
  for (M left = lanes; Any(left); ++found) {
    const int lane = FirstLane(left);
    for (int dy = 0; dy < 2; ++dy) {
      NeedVertex(lights, s, xs[lane], ys[lane] + dy);
      NeedVertex(lights, s, xs[lane] + 1, ys[lane] + dy);
    }
    left = Without(left, cell == Set(cells[lane]));
  }
  return found == 1;
}

// Interpolates between the vertices of the grid's triangles: (0, 1, 3) and (1,
// 2, 3) of a cell whose corners are numbered around it.
SHOAL_INLINE Colour GridLight(const LightSet& lights, const Surface& s, M lanes, Vector p) {
  const PlaneGrid& grid = *s.grid;
  const GridCell x = FindCell(grid, 0, EvalAxes(s.grid_axes[0], p));
  const GridCell y = FindCell(grid, 1, EvalAxes(s.grid_axes[1], p));
  const I origin = Times(y.index, grid.stride) + x.index;
  const bool one_cell = NeedCells(lights, s, lanes, x.index, y.index, origin);
  const F one = Set(1.0f);
  const M low = one >= x.fraction + y.fraction;
  const F u = Select(low, x.fraction, one - x.fraction);
  const F v = Select(low, y.fraction, one - y.fraction);
  const auto mix = [u, v](F a, F b, F c) { return a + u * (b - a) + v * (c - a); };
  Colour colour;
  F* channels[3] = {&colour.r, &colour.g, &colour.b};
  const int count = s.grey_grid ? 1 : 3;
  if (one_cell) {
    alignas(64) int32_t cells[kLanes];
    Store(cells, origin);
    const int at = cells[FirstLane(lanes)];
    for (int c = 0; c < count; ++c) {
      const float* light = grid.light[c] + at;
      const float* upper = light + grid.stride;
      *channels[c] =
          mix(Select(low, Set(light[0]), Set(upper[1])), Select(low, Set(light[1]), Set(upper[0])),
              Select(low, Set(upper[0]), Set(light[1])));
    }
  } else {
    for (int c = 0; c < count; ++c) {
      const Quads corners = GatherQuads(grid.light[c], grid.stride, origin);
      *channels[c] = mix(Select(low, corners.upper_left, corners.lower_right),
                         Select(low, corners.upper_right, corners.lower_left),
                         Select(low, corners.lower_left, corners.upper_right));
    }
  }
  if (count == 1) colour.g = colour.b = colour.r;
  return colour;
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// Light of planes at the vertices of their grids. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lane_gathers.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/light_kernels.h"

namespace {

using namespace shoal::worlds::native;

// Stores the light of the vertices of `row` from vertex `at` on.
SHOAL_INLINE void StoreLight(const PlaneGrid& grid, int channel, int row, int at, F light) {
  alignas(64) float values[kLanes];
  Store(values, light);
  LightPair* pairs = grid.light[channel] + row * grid.stride + at;
  for (int i = 0; i < kLanes; ++i) pairs[i].upper = values[i];
  if (row == 0) return;
  pairs -= grid.stride;
  for (int i = 0; i < kLanes; ++i) pairs[i].lower = values[i];
}

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
    if (s.grey_grid) {
      StoreLight(grid, 0, row, i, LightAt<true>(lights, s, p, normal, to_eye).r);
      continue;
    }
    const Colour colour = LightAt<false>(lights, s, p, normal, to_eye);
    StoreLight(grid, 0, row, i, colour.r);
    StoreLight(grid, 1, row, i, colour.g);
    StoreLight(grid, 2, row, i, colour.b);
  }
}

SHOAL_INLINE void NeedBlock(const LightSet& lights, const Surface& s, int row, int block) {
  uint32_t& stamp = s.grid->stamps[row * (s.grid->stride >> kTilePixelsLog2) + block];
  if (stamp == s.stamp) return;
  stamp = s.stamp;
  LightBlock(lights, s, row, block);
}

// Cells of a grid whose corners are lit, bounds included. Groups of lanes within them need not
// check whether their corners are lit.
struct LitCells {
  int left = 0, right = -1, top = 0, bottom = -1;
};

// Lights the corners of the cells of the lanes in `lanes`, and of all cells between them and
// `lit`, which grows.
inline __attribute__((noinline)) void LightCells(const LightSet& lights, const Surface& s, M lanes,
                                                 I x, I y, LitCells* lit) {
  alignas(64) int32_t xs[kLanes], ys[kLanes];
  Store(xs, x);
  Store(ys, y);
  LitCells all = *lit;
  if (all.right < all.left) {
    const int lane = FirstLane(lanes);
    all = {xs[lane], xs[lane], ys[lane], ys[lane]};
  }
  for (uint32_t left = LaneBits(lanes); left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    if (xs[lane] < all.left) all.left = xs[lane];
    if (xs[lane] > all.right) all.right = xs[lane];
    if (ys[lane] < all.top) all.top = ys[lane];
    if (ys[lane] > all.bottom) all.bottom = ys[lane];
  }
  // Vertices are lit in blocks. The last one of a block is no left corner of a lit cell.
  const int first = all.left >> kTilePixelsLog2, last = (all.right + 1) >> kTilePixelsLog2;
  all.left = first << kTilePixelsLog2;
  all.right = ((last + 1) << kTilePixelsLog2) - 2;
  for (int row = all.top; row <= all.bottom + 1; ++row) {
    for (int block = first; block <= last; ++block) NeedBlock(lights, s, row, block);
  }
  *lit = all;
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

// Interpolates between the vertices of the grid's triangles: (0, 1, 3) and (1,
// 2, 3) of a cell whose corners are numbered around it.
SHOAL_INLINE Colour GridLight(const LightSet& lights, const Surface& s, M lanes, Vector p,
                              LitCells* lit) {
  const PlaneGrid& grid = *s.grid;
  const GridCell x = FindCell(grid, 0, EvalAxes(s.grid_axes[0], p));
  const GridCell y = FindCell(grid, 1, EvalAxes(s.grid_axes[1], p));
  const M beside = (Set(int32_t{lit->left}) > x.index) | (x.index > Set(int32_t{lit->right}));
  const M beyond = (Set(int32_t{lit->top}) > y.index) | (y.index > Set(int32_t{lit->bottom}));
  if (Any(lanes & (beside | beyond))) LightCells(lights, s, lanes, x.index, y.index, lit);
  const I origin = Times(y.index, grid.stride) + x.index;
  alignas(64) int32_t origins[kLanes];
  Store(origins, origin);
  const int at = origins[FirstLane(lanes)];
  const F one = Set(1.0f);
  const M low = one >= x.fraction + y.fraction;
  const F u = Select(low, x.fraction, one - x.fraction);
  const F v = Select(low, y.fraction, one - y.fraction);
  const auto mix = [u, v](F a, F b, F c) { return a + u * (b - a) + v * (c - a); };
  Colour colour;
  F* channels[3] = {&colour.r, &colour.g, &colour.b};
  const int count = s.grey_grid ? 1 : 3;
  if (!Any(Without(lanes, origin == Set(int32_t{at})))) {  // all in one cell
    for (int c = 0; c < count; ++c) {
      const LightPair left = grid.light[c][at], right = grid.light[c][at + 1];
      *channels[c] = mix(Select(low, Set(left.upper), Set(right.lower)),
                         Select(low, Set(right.upper), Set(left.lower)),
                         Select(low, Set(left.lower), Set(right.upper)));
    }
  } else {
    for (int c = 0; c < count; ++c) {
      const Quads corners = GatherQuads(grid.light[c], origin);
      *channels[c] = mix(Select(low, corners.upper_left, corners.lower_right),
                         Select(low, corners.upper_right, corners.lower_left),
                         Select(low, corners.lower_left, corners.upper_right));
    }
  }
  if (count == 1) colour.g = colour.b = colour.r;
  return colour;
}

}  // namespace

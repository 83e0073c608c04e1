// SPDX-License-Identifier: Apache-2.0
// Colour of the pixels of one surface. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/grid_kernels.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/light_kernels.h"
#include "actor/worlds/native/mesh_kernels.h"
#include "actor/worlds/native/texture_kernels.h"

namespace {

using namespace shoal::worlds::native;

SHOAL_INLINE Vector NormalOf(const Surface& s, Vector p) {
  if (s.normal_kind == kFlat) return Set(s.normal);
  const Vector from = Minus(p, Set(s.centre));
  if (s.normal_kind == kRound) return Scale(Set(s.inverse_radius), from);
  if (s.normal_kind == kRod) {
    const Vector axis = Set(s.axis);
    const F limit = Set(s.half_length);
    const F along = Max(Min(Dot(axis, from), limit), Set(0.0f) - limit);
    return Scale(Set(s.inverse_radius), Minus(from, Scale(along, axis)));
  }
  const Vector n{Dot(Set(s.gram), from), Dot(Set(s.gram + 3), from), Dot(Set(s.gram + 6), from)};
  return Scale(Set(1.0f) / Max(Sqrt(Dot(n, n)), Set(1e-20f)), n);
}

// Slope of the surface's tangent plane against the ray: normal / (normal . ray).
SHOAL_INLINE void TurnOf(const Surface& s, Vector n, Vector ray, F depth, F* turn_x, F* turn_y) {
  if (s.normal_kind == kFlat) {
    *turn_x = Set(s.turn[0]) * depth;
    *turn_y = Set(s.turn[1]) * depth;
    return;
  }
  const F slant = Dot(n, ray);
  const F away = Select(slant >= Set(0.0f), Max(slant, Set(1e-6f)), Min(slant, Set(-1e-6f)));
  const F inverse = Set(1.0f) / away;
  *turn_x = n.x * inverse;
  *turn_y = n.y * inverse;
}

// ray: (X, Y, 1); p = ray / w. The change of the texture coordinates from pixel to pixel is
// computed on the tangent plane: dp/dX = (e_x - ray * n_x / (n . ray)) / w.
SHOAL_INLINE Footprint FootprintOf(const View& view, const Surface& s, Vector ray, Vector p,
                                   F turn_x, F turn_y, F depth) {
  const F zero = Set(0.0f);
  const F pixel = depth * Set(view.pixel);
  Footprint f;
  F* at[3] = {&f.at.x, &f.at.y, &f.at.z};
  F* right[3] = {&f.right.x, &f.right.y, &f.right.z};
  F* down[3] = {&f.down.x, &f.down.y, &f.down.z};
  M above = zero > zero, below = above;
  if (s.capsule_caps) {
    const F along = Dot(Set(s.axis), Minus(p, Set(s.centre)));
    above = along > Set(s.half_length);
    below = Set(-s.half_length) > along;
  }
  for (int i = 0; i < (s.mapping == kMapCube ? 3 : 2); ++i) {
    const float* axes = s.texture_axes[i];
    const F along = Set(axes[0]) * ray.x + Set(axes[1]) * ray.y + Set(axes[2]);
    F scale = pixel;
    *at[i] = EvalAxes(axes, p);
    if (i == 2 && s.capsule_caps) {
      const F beyond = Select(above, Set(s.cap_offset), Set(-s.cap_offset));
      const M cap = above | below;
      *at[i] = Select(cap, (*at[i] - beyond) * Set(s.cap_scale), *at[i]);
      scale = Select(cap, scale * Set(s.cap_scale), scale);
    }
    *right[i] = scale * (Set(axes[0]) - along * turn_x);
    *down[i] = scale * (Set(axes[1]) - along * turn_y);
  }
  return f;
}

SHOAL_INLINE I Pack(Colour c) {
  const F one = Set(1.0f), full = Set(255.0f), half = Set(0.5f);
  const I r = Truncate(Min(c.r, one) * full + half);
  const I g = Truncate(Min(c.g, one) * full + half);
  const I b = Truncate(Min(c.b, one) * full + half);
  return r | ShiftLeft<8>(g) | ShiftLeft<16>(b);
}

struct Group {
  M mine;  // lanes of the surface; values in other lanes are undefined
  F x, y, w, inverse_length;
  I triangle;
};

// Results that later groups of the same surface use.
struct Passed {
  FaceLight face;  // if the surface has one_dull_light
  LitCells lit;    // if it has a grid
  int level = 0;   // of its texture
};

SHOAL_INLINE Colour LightOf(const LightSet& lights, const Surface& s, const Group& g, Vector p,
                            Vector n, Vector ray, Passed* passed) {
  if (s.one_light) return {Set(s.light[0]), Set(s.light[1]), Set(s.light[2])};
  if (s.grid != nullptr) return GridLight(lights, s, g.mine, p, &passed->lit);
  const Vector to_eye = Scale(Set(0.0f) - g.inverse_length, ray);
  if (s.one_dull_light && !MayShine(s, passed->face, g.mine, to_eye)) return passed->face.dull;
  return LightAt<false>(lights, s, p, n, to_eye);
}

template <bool kMesh>
SHOAL_INLINE I ShadeGroup(const View& view, const LightSet& lights, const Surface& s,
                          const Group& g, Passed* passed) {
  const F depth = Set(1.0f) / Select(g.mine, g.w, Set(1.0f));
  const Vector ray{g.x, g.y, Set(1.0f)};
  const Vector p = Scale(depth, ray);
  [[maybe_unused]] MeshPoint mesh;
  Vector n;
  if constexpr (kMesh) {
    mesh = MeshAt(view, s, g.mine, g.triangle, g.x, g.y, depth);
    n = mesh.normal;
  } else {
    n = NormalOf(s, p);
  }
  Colour colour = LightOf(lights, s, g, p, n, ray, passed);
  if (s.mapping != kNoTexture) {
    Footprint f;
    if constexpr (kMesh) {
      f = s.mesh.coords != nullptr ? mesh.coords
                                   : FootprintOf(view, s, ray, p, mesh.turn_x, mesh.turn_y, depth);
    } else {
      F turn_x, turn_y;
      TurnOf(s, n, ray, depth, &turn_x, &turn_y);
      f = FootprintOf(view, s, ray, p, turn_x, turn_y, depth);
    }
    int* likely = &passed->level;
    const Colour texel = s.mapping == kMap2d
                             ? LookUp2d(*s.texture, g.mine, f, likely)
                             : LookUpCube</*kTogether=*/false>(*s.texture, g.mine, f, likely);
    colour = {colour.r * texel.r, colour.g * texel.g, colour.b * texel.b};
  }
  return Pack(colour);
}

template <bool kMesh>
SHOAL_INLINE void ShadeRect(const View& view, const LightSet& lights, const Surface& s,
                            const Tiles& tiles) {
  const bool uniform = s.one_light && s.mapping == kNoTexture;
  const I colour = Pack({Set(s.light[0]), Set(s.light[1]), Set(s.light[2])});
  Passed passed;
  if (s.one_dull_light) MakeFaceLight(lights, s, &passed.face);
  for (int row = s.rect.top; row < s.rect.bottom; ++row) {
    passed.lit = {};  // far and near rows see other cells
    for (int column = s.rect.left; column < s.rect.right; ++column) {
      const int64_t tile = (int64_t{row} * view.tiles_x + column) * kTilePixels;
      for (int i = 0; i < kTilePixels; i += kLanes) {
        const M mine = Load(tiles.id + tile + i) == Set(int32_t{s.id});
        if (!Any(mine)) continue;
        I shaded = colour;
        if (!uniform) {
          Group group{mine,
                      Load(view.ray_x + column * kTilePixels + i),
                      Load(view.ray_y + row * kTilePixels + i),
                      Load(tiles.w + tile + i),
                      Load(view.inverse_length + tile + i),
                      Set(int32_t{0})};
          if constexpr (kMesh) group.triangle = Load(tiles.triangle + tile + i);
          shaded = ShadeGroup<kMesh>(view, lights, s, group, &passed);
        }
        Store(tiles.colour + tile + i, Select(mine, shaded, Load(tiles.colour + tile + i)));
      }
    }
  }
}

void Shade(const View& view, const LightSet& lights, const Surface& s, const Tiles& tiles) {
  if (s.normal_kind == kMeshNormals) {
    ShadeRect<true>(view, lights, s, tiles);
  } else {
    ShadeRect<false>(view, lights, s, tiles);
  }
}

}  // namespace

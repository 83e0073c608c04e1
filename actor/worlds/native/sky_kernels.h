// SPDX-License-Identifier: Apache-2.0
// The sky and the haze at its foot. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/shading_kernels.h"
#include "actor/worlds/native/texture_kernels.h"

namespace {

using namespace shoal::worlds::native;

SHOAL_INLINE F AlongRay(const float* axis, F x, F y) {
  return Set(axis[0]) * x + Set(axis[1]) * y + Set(axis[2]);
}

// The sky is a cube around the eye; its texture is not lit. `likely`: see SampleLevels.
SHOAL_INLINE I SkyColour(const View& view, M lanes, F x, F y, int* likely) {
  const float(*axes)[3] = view.sky_axes;
  const F pixel = Set(view.pixel);
  const auto at = [&](int k) { return AlongRay(axes[k], x, y); };
  const auto right = [&](int k) { return Set(axes[k][0]) * pixel; };
  const auto down = [&](int k) { return Set(axes[k][1]) * pixel; };
  const Footprint f{
      {at(0), at(1), at(2)}, {right(0), right(1), right(2)}, {down(0), down(1), down(2)}};
  return Pack(LookUpCube</*kTogether=*/true>(*view.sky, lanes, f, likely));
}

// Calls visit(x, y, at) for each group of lanes, with the group's rays and index in the tiles.
template <typename Visit>
SHOAL_INLINE void ForEachRay(const View& view, const Visit& visit) {
  for (int row = 0; row < view.tiles_y; ++row) {
    for (int column = 0; column < view.tiles_x; ++column) {
      const int64_t tile = (int64_t{row} * view.tiles_x + column) * kTilePixels;
      for (int i = 0; i < kTilePixels; i += kLanes) {
        visit(Load(view.ray_x + column * kTilePixels + i), Load(view.ray_y + row * kTilePixels + i),
              tile + i);
      }
    }
  }
}

void Sky(const View& view, const Tiles& tiles) {
  int level = 0;
  ForEachRay(view, [&](F x, F y, int64_t at) {
    const M bare = Load(tiles.id + at) == Set(int32_t{kNothing});
    if (!Any(bare)) return;
    const I sky = SkyColour(view, bare, x, y, &level);
    Store(tiles.colour + at, Select(bare, sky, Load(tiles.colour + at)));
  });
}

// 1 / the depth of the cylinder on which the engine paints the sky. Cube coordinates are x, z and
// -y of the world.
SHOAL_INLINE F SkyDepth(const View& view, const Haze& haze, F x, F y) {
  const F east = AlongRay(view.sky_axes[0], x, y), up = AlongRay(view.sky_axes[1], x, y);
  const F north = AlongRay(view.sky_axes[2], x, y);
  return Max(Sqrt(east * east + north * north), Abs(up)) * Set(haze.inverse_sky);
}

// The haze's share of a pixel whose depth is 1 / w.
SHOAL_INLINE F HazeShare(const Haze& haze, F x, F y, F w) {
  const F zero = Set(0.0f), one = Set(1.0f);
  const F along_x = AlongRay(haze.axes[0], x, y), along_y = AlongRay(haze.axes[1], x, y);
  const F level = Sqrt(along_x * along_x + along_y * along_y);
  const F fall = zero - AlongRay(haze.axes[2], x, y);
  // The cone is at height -elevation * share where its radius is 1 - width * share.
  const F share = fall / Max(Set(haze.elevation) * level + Set(haze.width) * fall, Set(1e-20f));
  const F radius = one - Set(haze.width) * share;
  const F depth = level * Set(haze.inverse_sky) / Max(radius, Set(1e-20f));
  const M seen = (fall >= zero) & (one >= share) & (radius > zero) & (depth >= w);
  const F rising = share / Set(haze.peak), falling = (one - share) / Set(1.0f - haze.peak);
  return Select(seen, Min(rising, falling), zero);
}

void DrawHaze(const View& view, const Haze& haze, const Tiles& tiles) {
  const F half = Set(0.5f);
  const I byte = Set(int32_t{255});
  int level = 0;
  ForEachRay(view, [&](F x, F y, int64_t at) {
    const F w = Load(tiles.w + at);
    I colour = Load(tiles.colour + at);
    const F sky = SkyDepth(view, haze, x, y);
    const M beyond = (Load(tiles.id + at) > Set(int32_t{kNothing})) & (sky > w);
    if (Any(beyond)) colour = Select(beyond, SkyColour(view, beyond, x, y, &level), colour);
    Store(tiles.colour + at, colour);
    Store(tiles.w + at, Max(w, sky));
    if (!haze.seen) return;
    const F share = HazeShare(haze, x, y, w), rest = Set(1.0f) - share;
    const auto mix = [&](int c, I below) {
      return Truncate(share * Set(haze.rgb[c]) + rest * ToFloat(below & byte) + half);
    };
    const I red = mix(0, colour), green = mix(1, ShiftRight<8>(colour));
    const I blue = mix(2, ShiftRight<16>(colour));
    Store(tiles.colour + at, red | ShiftLeft<8>(green) | ShiftLeft<16>(blue));
  });
}

}  // namespace

// SPDX-License-Identifier: Apache-2.0
// Texture look-up with mip levels. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lane_gathers.h"
#include "actor/worlds/native/lanes.h"

namespace {

using namespace shoal::worlds::native;

struct Colour {
  F r, g, b;
};

struct Vector {
  F x, y, z;
};

// Texture coordinates of a pixel, and how they change to the next pixel on its
// right and below.
struct Footprint {
  Vector at, right, down;
};

// Blends two texels' 16-bit halves: `weight` of b in 256ths, in both halves.
SHOAL_INLINE I Lerp16(I a, I b, I weight) {
  const I rest = Subtract16(Set(int32_t{0x01000100}), weight);
  return ShiftRight16<8>(Add16(Multiply16(a, rest), Multiply16(b, weight)));
}

// A fraction in [0, 1) as 256ths in both halves.
SHOAL_INLINE I Weight16(F fraction) {
  const I weight = Truncate(fraction * Set(256.0f));
  return weight | ShiftLeft<16>(weight);
}

struct Texels {
  I red_blue, green;
};

SHOAL_INLINE Texels Split(I texel) {
  return {texel & Set(int32_t{0x00ff00ff}), ShiftRight<8>(texel) & Set(int32_t{0x000000ff})};
}

SHOAL_INLINE Texels Mix(Texels a, Texels b, I weight) {
  return {Lerp16(a.red_blue, b.red_blue, weight), Lerp16(a.green, b.green, weight)};
}

// Interpolates between the four texels whose upper left one is at `upper_left`.
SHOAL_INLINE Texels Bilinear(const TexelPair* texels, I upper_left, F fx, F fy) {
  const I wx = Weight16(fx), wy = Weight16(fy);
  const Quads quads = GatherQuads(texels, upper_left);
  const Texels top = Mix(Split(Bits(quads.upper_left)), Split(Bits(quads.upper_right)), wx);
  return Mix(top, Mix(Split(Bits(quads.lower_left)), Split(Bits(quads.lower_right)), wx), wy);
}

SHOAL_INLINE I Times(I a, int b) { return a * Set(int32_t{b}); }

// The place in a texture that repeats, in [0, 1).
SHOAL_INLINE F Repeated(F at) {
  const F limit = Set(1e6f);
  const F limited = Max(Min(at, limit), Set(0.0f) - limit);
  return Min(limited - ToFloat(Floor(limited)), Set(0.99999994f));
}

// s and t are in [0, 1). Rows begin with their last texel and end with their first.
SHOAL_INLINE Texels Sample2d(const Texture& texture, int level, F s, F t) {
  const int width = texture.width[level], height = texture.height[level];
  const F x = s * Set(static_cast<float>(width)) + Set(0.5f);
  const F y = t * Set(static_cast<float>(height)) + Set(0.5f);
  const I column = Truncate(x), row = Truncate(y);
  return Bilinear(texture.level[level], Times(row, width + 2) + column, x - ToFloat(column),
                  y - ToFloat(row));
}

// Samples a face of a cube at u and v in [0, 1], clamped to the face's edges: each face has a frame
// that repeats its own edges.
SHOAL_INLINE Texels SampleCube(const Texture& texture, int level, I face, F u, F v) {
  const int size = texture.width[level];
  const auto scaled = [size](F at) {
    return Min(Max(at, Set(0.0f)), Set(1.0f)) * Set(static_cast<float>(size)) + Set(0.5f);
  };
  const F x = scaled(u), y = scaled(v);
  const I column = Min(Truncate(x), Set(int32_t{size})), row = Min(Truncate(y), Set(int32_t{size}));
  const I upper_left = Times(Times(face, size + 1) + row, size + 2) + column;
  return Bilinear(texture.level[level], upper_left, x - ToFloat(column), y - ToFloat(row));
}

// Level and weight of the next one for a footprint of `rho` texels, as llvmpipe
// chooses them.
SHOAL_INLINE void ChooseLevel(F rho, int levels, I* level, F* weight) {
  const I bits = Bits(Max(rho * Set(1.2374f), Set(0.5f)));
  const I exponent = ShiftRight<23>(bits) - Set(int32_t{127});
  const F mantissa = FromBits((bits & Set(int32_t{0x7fffff})) | Set(int32_t{0x3f800000}));
  const F next = Max(mantissa + mantissa - Set(3.0f), Set(0.0f));
  const I last = Set(int32_t{levels - 1});
  *level = Max(Min(exponent, last), Set(int32_t{0}));
  *weight = Select((Set(int32_t{0}) > exponent) | (*level == last), Set(0.0f), next);
}

// Samples the lanes of `lanes` at their own levels; other lanes get undefined values. Lanes of one
// group, and neighbouring groups, rarely differ in their level: `likely`, a level of the texture,
// is tried first, so that its addresses need not wait for the lanes' own. It becomes one of theirs.
template <typename Sample>
SHOAL_INLINE Colour SampleLevels(M lanes, I level, F weight, const Sample& sample, int* likely) {
  const M mixed = weight > Set(0.0f);
  Texels texels{Set(int32_t{0}), Set(int32_t{0})};
  Texels fine = texels, coarse = texels;   // samples of two levels, which the next pass may need
  int fine_level = -1, coarse_level = -1;  // none
  int here = *likely;
  M left = lanes;
  while (true) {
    const M same = left & (level == Set(int32_t{here}));
    if (Any(same)) {
      const Texels nearest = here == coarse_level ? coarse : sample(here);
      Texels found = nearest;
      if (Any(same & mixed)) {
        coarse = here + 1 == fine_level ? fine : sample(here + 1);
        coarse_level = here + 1;
        found = Mix(nearest, coarse, Weight16(weight));
      }
      fine = nearest;
      fine_level = here;
      texels.red_blue = Select(same, found.red_blue, texels.red_blue);
      texels.green = Select(same, found.green, texels.green);
      left = Without(left, same);
    }
    if (!Any(left)) break;
    alignas(64) int32_t levels[kLanes];
    Store(levels, level);
    here = levels[FirstLane(left)];
  }
  *likely = here;
  const F unit = Set(1.0f / 255);
  return {ToFloat(texels.red_blue & Set(int32_t{255})) * unit, ToFloat(texels.green) * unit,
          ToFloat(ShiftRight<16>(texels.red_blue)) * unit};
}

SHOAL_INLINE Colour LookUp2d(const Texture& texture, M lanes, const Footprint& f, int* likely) {
  const F width = Set(static_cast<float>(texture.width[0]));
  const F height = Set(static_cast<float>(texture.height[0]));
  const F rho =
      Max(Max(Abs(f.right.x), Abs(f.down.x)) * width, Max(Abs(f.right.y), Abs(f.down.y)) * height);
  I level;
  F weight;
  ChooseLevel(rho, texture.levels, &level, &weight);
  const F s = Repeated(f.at.x), t = Repeated(f.at.y);
  return SampleLevels(
      lanes, level, weight,
      [&](int here) __attribute__((always_inline)) { return Sample2d(texture, here, s, t); },
      likely);
}

// The axis of the face of a cube that directions meet: one for all lanes, or each lane's own.
enum FaceAxis { kFaceX, kFaceY, kFaceZ, kFaceOfLane };

struct CubeAxes {
  M x, y;  // neither = z
};

template <FaceAxis kAxis>
SHOAL_INLINE F Along(const CubeAxes& axes, F x, F y, F z) {
  if constexpr (kAxis == kFaceX) return x;
  if constexpr (kAxis == kFaceY) return y;
  if constexpr (kAxis == kFaceZ) return z;
  return Select(axes.x, x, Select(axes.y, y, z));
}

struct CubePoint {
  I face;
  F u, v;   // in [-1, 1]: right / major and down / major, with OpenGL's orientation of the faces
  F slope;  // of u and v from pixel to pixel
};

template <FaceAxis kAxis>
SHOAL_INLINE CubePoint PointOnCube(const CubeAxes& axes, const Footprint& f) {
  const F zero = Set(0.0f), one = Set(1.0f), minus = Set(-1.0f);
  const auto along = [&](F x, F y, F z) { return Along<kAxis>(axes, x, y, z); };
  const F major = along(f.at.x, f.at.y, f.at.z);
  const F sign = Select(major >= zero, one, minus);
  // +x: (-z, -y), -x: (z, -y), +y: (x, z), -y: (x, -z), +z: (x, -y), -z: (-x,
  // -y)
  const F sign_u = along(zero - sign, one, sign), sign_v = along(minus, sign, minus);
  const auto u_of = [&](const Vector& v) { return sign_u * along(v.z, v.x, v.x); };
  const auto v_of = [&](const Vector& v) { return sign_v * along(v.y, v.z, v.y); };
  const auto m_of = [&](const Vector& v) { return sign * along(v.x, v.y, v.z); };
  const F inverse = one / Max(Abs(major), Set(1e-20f));
  const F u = u_of(f.at) * inverse, v = v_of(f.at) * inverse;
  const auto slope = [&](const Vector& d) {
    const F m = m_of(d);
    return Max(Abs((u_of(d) - u * m) * inverse), Abs((v_of(d) - v * m) * inverse));
  };
  const F first = along(Set(0.0f), Set(2.0f), Set(4.0f));
  return {Truncate(first + Select(zero > major, one, zero)), u, v,
          Max(slope(f.right), slope(f.down))};
}

// kTogether: the lanes likely meet one face.
template <bool kTogether>
SHOAL_INLINE Colour LookUpCube(const Texture& texture, M lanes, const Footprint& f, int* likely) {
  const F ax = Abs(f.at.x), ay = Abs(f.at.y), az = Abs(f.at.z);
  CubeAxes axes;
  axes.x = (ax >= ay) & (ax >= az);
  axes.y = Without(ay >= az, axes.x);
  CubePoint at;
  if (kTogether && !Any(Without(lanes, axes.y))) {
    at = PointOnCube<kFaceY>(axes, f);
  } else if (kTogether && !Any(Without(lanes, axes.x))) {
    at = PointOnCube<kFaceX>(axes, f);
  } else if (kTogether && !Any(lanes & (axes.x | axes.y))) {
    at = PointOnCube<kFaceZ>(axes, f);
  } else {
    at = PointOnCube<kFaceOfLane>(axes, f);
  }
  const F size = Set(0.5f * static_cast<float>(texture.width[0]));
  I level;
  F weight;
  ChooseLevel(at.slope * size, texture.levels, &level, &weight);
  const F half = Set(0.5f);
  const F u = at.u * half + half, v = at.v * half + half;
  return SampleLevels(
      lanes, level, weight,
      [&](int here)
          __attribute__((always_inline)) { return SampleCube(texture, here, at.face, u, v); },
      likely);
}

}  // namespace

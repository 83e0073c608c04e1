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
SHOAL_INLINE Texels Bilinear(const int32_t* texels, int stride, I upper_left, F fx, F fy) {
  const I wx = Weight16(fx), wy = Weight16(fy);
  const Quads quads = GatherQuads(texels, stride, upper_left);
  const Texels top = Mix(Split(Bits(quads.upper_left)), Split(Bits(quads.upper_right)), wx);
  return Mix(top, Mix(Split(Bits(quads.lower_left)), Split(Bits(quads.lower_right)), wx), wy);
}

SHOAL_INLINE I Times(I a, int b) { return a * Set(int32_t{b}); }

// s and t repeat. Rows begin with their last texel and end with their first.
SHOAL_INLINE Texels Sample2d(const Texture& texture, int level, F s, F t) {
  const int width = texture.width[level], height = texture.height[level];
  const auto scaled = [](F at, int size) {
    const F turns = at - ToFloat(Floor(at));
    return Min(turns, Set(0.99999994f)) * Set(static_cast<float>(size)) + Set(0.5f);
  };
  const F x = scaled(s, width), y = scaled(t, height);
  const I column = Truncate(x), row = Truncate(y);
  const int stride = width + 2;
  return Bilinear(texture.level[level], stride, Times(row, stride) + column, x - ToFloat(column),
                  y - ToFloat(row));
}

// Samples a face of a cube at u and v in [0, 1], clamped to the face's edges: each face has a frame
// that repeats its own edges.
SHOAL_INLINE Texels SampleCube(const Texture& texture, int level, I face, F u, F v) {
  const int size = texture.width[level], stride = size + 2;
  const auto scaled = [size](F at) {
    return Min(Max(at, Set(0.0f)), Set(1.0f)) * Set(static_cast<float>(size)) + Set(0.5f);
  };
  const F x = scaled(u), y = scaled(v);
  const I column = Min(Truncate(x), Set(int32_t{size})), row = Min(Truncate(y), Set(int32_t{size}));
  const I upper_left = Times(Times(face, stride) + row, stride) + column;
  return Bilinear(texture.level[level], stride, upper_left, x - ToFloat(column), y - ToFloat(row));
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
// group rarely differ in their level.
template <typename Sample>
SHOAL_INLINE Colour SampleLevels(M lanes, I level, F weight, const Sample& sample) {
  alignas(64) int32_t levels[kLanes];
  Store(levels, level);
  Texels texels{Set(int32_t{0}), Set(int32_t{0})};
  M left = lanes;
  while (Any(left)) {
    const int here = levels[FirstLane(left)];
    const M same = left & (level == Set(int32_t{here}));
    Texels found = sample(here);
    if (Any(same & (weight > Set(0.0f)))) {
      found = Mix(found, sample(here + 1), Weight16(weight));
    }
    texels.red_blue = Select(same, found.red_blue, texels.red_blue);
    texels.green = Select(same, found.green, texels.green);
    left = Without(left, same);
  }
  const F unit = Set(1.0f / 255);
  return {ToFloat(texels.red_blue & Set(int32_t{255})) * unit, ToFloat(texels.green) * unit,
          ToFloat(ShiftRight<16>(texels.red_blue)) * unit};
}

SHOAL_INLINE Colour LookUp2d(const Texture& texture, M lanes, const Footprint& f) {
  const F width = Set(static_cast<float>(texture.width[0]));
  const F height = Set(static_cast<float>(texture.height[0]));
  const F rho =
      Max(Max(Abs(f.right.x), Abs(f.down.x)) * width, Max(Abs(f.right.y), Abs(f.down.y)) * height);
  I level;
  F weight;
  ChooseLevel(rho, texture.levels, &level, &weight);
  const F limit = Set(1e6f);
  const F s = Max(Min(f.at.x, limit), Set(0.0f) - limit);
  const F t = Max(Min(f.at.y, limit), Set(0.0f) - limit);
  return SampleLevels(
      lanes, level, weight, [&](int here) __attribute__((always_inline)) {
        return Sample2d(texture, here, s, t);
      });
}

// The face that a direction meets and the axes on the face: u = right / major, v = down / major,
// with OpenGL's orientation of the faces.
struct CubeAxes {
  M x, y;  // the major axis; neither = z
  F sign_u, sign_v;
};

SHOAL_INLINE F Along(const CubeAxes& axes, F x, F y, F z) {
  return Select(axes.x, x, Select(axes.y, y, z));
}

SHOAL_INLINE Colour LookUpCube(const Texture& texture, M lanes, const Footprint& f) {
  const F ax = Abs(f.at.x), ay = Abs(f.at.y), az = Abs(f.at.z);
  const F zero = Set(0.0f), one = Set(1.0f), minus = Set(-1.0f);
  CubeAxes axes;
  axes.x = (ax >= ay) & (ax >= az);
  axes.y = Without(ay >= az, axes.x);
  const F major = Along(axes, f.at.x, f.at.y, f.at.z);
  const F sign = Select(major >= zero, one, minus);
  // +x: (-z, -y), -x: (z, -y), +y: (x, z), -y: (x, -z), +z: (x, -y), -z: (-x,
  // -y)
  axes.sign_u = Along(axes, zero - sign, one, sign);
  axes.sign_v = Along(axes, minus, sign, minus);
  const auto u_of = [&](const Vector& v) { return axes.sign_u * Along(axes, v.z, v.x, v.x); };
  const auto v_of = [&](const Vector& v) { return axes.sign_v * Along(axes, v.y, v.z, v.y); };
  const auto m_of = [&](const Vector& v) { return sign * Along(axes, v.x, v.y, v.z); };
  const F inverse = one / Max(Abs(major), Set(1e-20f));
  const F u = u_of(f.at) * inverse, v = v_of(f.at) * inverse;
  const auto slope = [&](const Vector& d) {
    const F m = m_of(d);
    return Max(Abs((u_of(d) - u * m) * inverse), Abs((v_of(d) - v * m) * inverse));
  };
  const F size = Set(0.5f * static_cast<float>(texture.width[0]));
  I level;
  F weight;
  ChooseLevel(Max(slope(f.right), slope(f.down)) * size, texture.levels, &level, &weight);
  const I negative = Select(zero > major, Set(int32_t{1}), Set(int32_t{0}));
  const I face =
      negative + Select(axes.x, Set(int32_t{0}), Select(axes.y, Set(int32_t{2}), Set(int32_t{4})));
  const F half = Set(0.5f);
  const F at_u = u * half + half, at_v = v * half + half;
  return SampleLevels(
      lanes, level, weight, [&](int here) __attribute__((always_inline)) {
        return SampleCube(texture, here, face, at_u, at_v);
      });
}

}  // namespace

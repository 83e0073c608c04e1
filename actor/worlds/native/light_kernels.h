// SPDX-License-Identifier: Apache-2.0
// Light on points of a surface. Included by the sources of the kernels.
//
// OpenGL's fixed-function light with the engine's settings: local viewer, one side, limited to full
// light before the texture is applied.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lanes.h"
#include "actor/worlds/native/texture_kernels.h"

namespace {

using namespace shoal::worlds::native;

SHOAL_INLINE F Dot(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
SHOAL_INLINE Vector Set(const float* v) { return {Set(v[0]), Set(v[1]), Set(v[2])}; }
SHOAL_INLINE Vector Minus(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
SHOAL_INLINE Vector Scale(F s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }

// x^n by squaring.
SHOAL_INLINE F WholePower(F x, int n) {
  F result = Set(1.0f);
  for (; n > 0; n >>= 1) {
    if (n & 1) result = result * x;
    x = x * x;
  }
  return result;
}

// x^e for x in [0, 1], e >= 0, to 1e-4 of the exponent: 2^(e * log2 x), both by
// polynomials.
SHOAL_INLINE F Power(F x, float e) {
  const I bits = Bits(Max(x, Set(1e-30f)));
  const F exponent = ToFloat(ShiftRight<23>(bits) - Set(int32_t{127}));
  const F m = FromBits((bits & Set(int32_t{0x7fffff})) | Set(int32_t{0x3f800000})) - Set(1.0f);
  // log2(1 + m) for m in [0, 1).
  const F log2 =
      exponent +
      m * (Set(1.44254494f) +
           m * (Set(-0.71814525f) +
                m * (Set(0.45754919f) +
                     m * (Set(-0.27735768f) + m * (Set(0.12191179f) + m * Set(-0.02651010f))))));
  const F power = Max(log2 * Set(e), Set(-120.0f));
  const I whole = Floor(power);
  const F r = power - ToFloat(whole);
  const F fraction =
      Set(1.0f) + r * (Set(0.69583282f) + r * (Set(0.22606716f) + r * Set(0.07802453f)));
  return fraction * FromBits(ShiftLeft<23>(whole + Set(int32_t{127})));
}

// The power of a cosine, from its square.
SHOAL_INLINE F Shine(const Surface& s, F squared) {
  const F limited = Min(squared, Set(1.0f));
  return s.whole_exponent >= 0 ? WholePower(limited, s.whole_exponent) : Power(limited, s.exponent);
}

struct Illumination {
  Vector to_light;  // unit
  F strength;       // attenuation times spot
};

SHOAL_INLINE Illumination Illuminate(const Light& light, Vector p) {
  if (light.directional) return {Set(light.direction), Set(1.0f)};
  const Vector to = Minus(Set(light.position), p);
  const F squared = Dot(to, to);
  const F distance = Sqrt(squared);
  const Vector unit = Scale(Set(1.0f) / Max(distance, Set(1e-12f)), to);
  F strength = Set(1.0f) / (Set(light.attenuation[0]) + Set(light.attenuation[1]) * distance +
                            Set(light.attenuation[2]) * squared);
  if (light.cutoff_cosine > -1) {
    const F cosine = Set(0.0f) - Dot(unit, Set(light.direction));
    const F spot = light.exponent == 0
                       ? Set(1.0f)
                       : Power(Min(Max(cosine, Set(0.0f)), Set(1.0f)), light.exponent);
    strength = Select(cosine >= Set(light.cutoff_cosine), strength * spot, Set(0.0f));
  }
  return {unit, strength};
}

// p: points; n: unit normals; to_eye: units, read only if the surface shines.
// kGrey: red stands for all channels.
template <bool kGrey>
SHOAL_INLINE Colour LightAt(const LightSet& lights, const Surface& s, Vector p, Vector n,
                            Vector to_eye) {
  constexpr int kChannels = kGrey ? 1 : 3;
  const F zero = Set(0.0f), one = Set(1.0f);
  F sum[kChannels], limited[kChannels];
  for (int c = 0; c < kChannels; ++c) {
    sum[c] = Set(s.emission[c]);
    limited[c] = zero;
  }
  const F eye_cosine = s.specular ? Dot(n, to_eye) : zero;
  for (int i = 0; i < lights.count; ++i) {
    const Light& light = lights.light[i];
    const LightColour& colour = s.colours[i];
    if (light.own_pass && !s.merged_passes) {
      for (int c = 0; c < kChannels; ++c) {
        limited[c] = limited[c] + Min(sum[c], one);
        sum[c] = zero;
      }
    }
    const Illumination from = Illuminate(light, p);
    const F facing = Dot(n, from.to_light);
    const M lit = facing > zero;
    const F diffuse = Max(facing, zero);
    F here[kChannels];
    for (int c = 0; c < kChannels; ++c) {
      here[c] = Set(colour.ambient[c]) + Set(colour.diffuse[c]) * diffuse;
    }
    if (s.specular && light.specular && Any(lit)) {
      // The half vector between light and eye, (l + e) / |l + e|.
      const F half = facing + eye_cosine;
      const F length = Set(2.0f) + Set(2.0f) * Dot(from.to_light, to_eye);
      const F squared = half * half / Max(length, Set(1e-12f));
      const M shines = lit & (half > zero) & (squared >= Set(s.least_shine));
      if (Any(shines)) {
        const F shine = Select(shines, Shine(s, squared), zero);
        for (int c = 0; c < kChannels; ++c) here[c] = here[c] + Set(colour.specular[c]) * shine;
      }
    }
    for (int c = 0; c < kChannels; ++c) {
      sum[c] = sum[c] + (light.directional ? here[c] : from.strength * here[c]);
    }
  }
  for (int c = 0; c < kChannels; ++c) limited[c] = limited[c] + Min(sum[c], one);
  return {limited[0], limited[kGrey ? 0 : 1], limited[kGrey ? 0 : 2]};
}

// The light of a plane under directional lights: the same everywhere but where it shines.
struct FaceLight {
  Colour dull;
  int shining;  // lights that may make it shine
  const Light* light[kMostLights];
  float facing[kMostLights];
};

SHOAL_INLINE void MakeFaceLight(const LightSet& lights, const Surface& s, FaceLight* face) {
  Surface dull = s;
  dull.specular = false;
  const Vector nowhere{Set(0.0f), Set(0.0f), Set(0.0f)};
  face->dull = LightAt<false>(lights, dull, nowhere, Set(s.normal), nowhere);
  face->shining = 0;
  for (int i = 0; i < lights.count; ++i) {
    const Light& light = lights.light[i];
    const float* to = light.direction;
    const float facing = s.normal[0] * to[0] + s.normal[1] * to[1] + s.normal[2] * to[2];
    if (!light.specular || !(facing > 0)) continue;
    face->light[face->shining] = &light;
    face->facing[face->shining++] = facing;
  }
}

// False: LightAt gives `face.dull` in all lanes of `lanes`. Cheaper than LightAt, and true of few
// lanes that do not shine: the margin is far above what rounding makes of least_shine.
SHOAL_INLINE bool MayShine(const Surface& s, const FaceLight& face, M lanes, Vector to_eye) {
  const F zero = Set(0.0f), least = Set(s.least_shine * 0.9999f);
  const F eye_cosine = Dot(Set(s.normal), to_eye);
  M shines = zero > zero;
  for (int i = 0; i < face.shining; ++i) {
    const F half = Set(face.facing[i]) + eye_cosine;
    const F length = Set(2.0f) + Set(2.0f) * Dot(Set(face.light[i]->direction), to_eye);
    shines = shines | ((half > zero) & (half * half >= least * Max(length, Set(1e-12f))));
  }
  return Any(shines & lanes);
}

SHOAL_INLINE F EvalAxes(const float* axes, Vector p) {
  return Set(axes[0]) * p.x + Set(axes[1]) * p.y + Set(axes[2]) * p.z + Set(axes[3]);
}

}  // namespace

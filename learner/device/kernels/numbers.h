// SPDX-License-Identifier: Apache-2.0
// Numbers of kernels: bf16 (the upper 16 bits of an f32, like common/nn/bf16.h) and arrays that are
// f32 or bf16.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "learner/device/kernels/frame.h"

namespace shoal::learner::kernels {

constexpr double kHalfLogTwoPi = 0.91893853320467274;  // log(2 pi) / 2

template <class T>
SHOAL_EVERYWHERE T Least(T a, T b) {
  return b < a ? b : a;
}
template <class T>
SHOAL_EVERYWHERE T Most(T a, T b) {
  return a < b ? b : a;
}
// x within [low, high]; NaN stays NaN.
template <class T>
SHOAL_EVERYWHERE T Clamp(T x, T low, T high) {
  return x < low ? low : high < x ? high : x;
}

SHOAL_KERNEL float FromBf16(uint16_t bits) {
  const uint32_t wide = uint32_t(bits) << 16;
  float value;
  memcpy(&value, &wide, sizeof(value));
  return value;
}

// Rounds to the nearest bf16, ties to even. NaN stays NaN.
SHOAL_KERNEL uint16_t ToBf16(float value) {
  uint32_t bits;
  memcpy(&bits, &value, sizeof(bits));
  if ((bits & 0x7fffffffu) > 0x7f800000u) return uint16_t((bits >> 16) | 0x40u);
  return uint16_t((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16);
}

// An array to read, f32 or bf16.
struct Source {
  const float* f32 = nullptr;      // null: bf16
  const uint16_t* bf16 = nullptr;  // read if f32 is null

  bool operator==(const Source&) const = default;
  SHOAL_KERNEL float operator[](int64_t i) const {
    return f32 != nullptr ? f32[i] : FromBf16(bf16[i]);
  }
};

// An array to write in one or both types; null: not in this type.
struct Target {
  float* f32 = nullptr;
  uint16_t* bf16 = nullptr;

  bool operator==(const Target&) const = default;
  SHOAL_KERNEL void Set(int64_t i, float value) const {
    if (f32 != nullptr) f32[i] = value;
    if (bf16 != nullptr) bf16[i] = ToBf16(value);
  }
};

// Writes a number that may be absent.
SHOAL_KERNEL void SetNumber(double* number, double value) {
  if (number != nullptr) *number = value;
}

}  // namespace shoal::learner::kernels

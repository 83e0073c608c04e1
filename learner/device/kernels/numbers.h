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

// Eight adjacent bf16 numbers, which one instruction of a card reads or writes.
struct alignas(16) Eight {
  uint16_t numbers[8];

  SHOAL_KERNEL static Eight Zero() {
    Eight zero;
    for (uint16_t& number : zero.numbers) number = 0;
    return zero;
  }
};
// At an address that is aligned to 16 bytes.
SHOAL_KERNEL Eight ReadEight(const uint16_t* from) { return *reinterpret_cast<const Eight*>(from); }
SHOAL_KERNEL void WriteEight(const Eight& eight, uint16_t* to) {
  *reinterpret_cast<Eight*>(to) = eight;
}

// At an address that is aligned to 4 bytes. The first byte is the lowest.
SHOAL_KERNEL uint32_t ReadFourBytes(const uint8_t* from) {
#ifdef __CUDA_ARCH__
  return *reinterpret_cast<const uint32_t*>(from);  // memcpy would read each byte
#else
  uint32_t bytes;
  memcpy(&bytes, from, sizeof(bytes));
  return bytes;
#endif
}

// Runs body(first) for the first of each eight of n numbers; n is a multiple of 8. One eight for
// each thread.
SHOAL_EVERYWHERE int BlocksForEights(int64_t n) { return int(CeilDivide(n / 8, kElementThreads)); }
template <class Block, class Body>
SHOAL_KERNEL void ForEights(Block& block, int64_t n, const Body& body) {
  block.Threads([&](int thread) {
    const int64_t first = (int64_t(block.index()) * kElementThreads + thread) * 8;
    if (first < n) body(first);
  });
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

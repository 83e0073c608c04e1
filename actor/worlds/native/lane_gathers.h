// SPDX-License-Identifier: Apache-2.0
// Gathers: each lane reads from its own place in an array. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/lanes.h"

namespace {

// The 16 bytes at base + 8 * index.
SHOAL_INLINE __m128 LoadQuad(const void* base, int32_t index) {
  return _mm_loadu_ps(
      reinterpret_cast<const float*>(static_cast<const char*>(base) + int64_t{8} * index));
}

// The quads of index[0], index[4], ... side by side.
SHOAL_INLINE F LoadQuads(const void* base, const int32_t* index) {
  const __m128 first = LoadQuad(base, index[0]);
#if SHOAL_LANES == 4
  return {first};
#else
  const __m256 low =
      _mm256_insertf128_ps(_mm256_castps128_ps256(first), LoadQuad(base, index[4]), 1);
#if SHOAL_LANES == 8
  return {low};
#else
  const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(LoadQuad(base, index[8])),
                                           LoadQuad(base, index[12]), 1);
  return {_mm512_insertf32x8(_mm512_castps256_ps512(low), high, 1)};
#endif
#endif
}

SHOAL_INLINE F InterleaveLow(F a, F b) {
  return {SHOAL_V(_mm_unpacklo_ps, _mm256_unpacklo_ps, _mm512_unpacklo_ps)(a.v, b.v)};
}
SHOAL_INLINE F InterleaveHigh(F a, F b) {
  return {SHOAL_V(_mm_unpackhi_ps, _mm256_unpackhi_ps, _mm512_unpackhi_ps)(a.v, b.v)};
}
// (a0 a1 b0 b1) and (a2 a3 b2 b3) of each 128 bits.
SHOAL_INLINE F FirstHalves(F a, F b) {
  return {SHOAL_V(_mm_shuffle_ps, _mm256_shuffle_ps, _mm512_shuffle_ps)(a.v, b.v, 0x44)};
}
SHOAL_INLINE F SecondHalves(F a, F b) {
  return {SHOAL_V(_mm_shuffle_ps, _mm256_shuffle_ps, _mm512_shuffle_ps)(a.v, b.v, 0xee)};
}

struct Quads {
  F upper_left, upper_right, lower_left, lower_right;
};

// Reads base[at] and base[at + 1] of each lane from rows of pairs (TexelPair, LightPair), as bits
// of either type. Each pair holds an upper and a lower value. Lanes must hold indices that exist,
// used or not. A load of 128 bits for each lane and a transposition are faster than gather
// instructions.
template <typename Pair>
SHOAL_INLINE Quads GatherQuads(const Pair* base, I at) {
  static_assert(sizeof(Pair) == 8);
  alignas(64) int32_t index[kLanes];
  Store(index, at);
  // Otherwise the compiler takes the vector apart lane by lane, which costs more than loads.
  asm("" : "+m"(index));
  const F q0 = LoadQuads(base, index), q1 = LoadQuads(base, index + 1);
  const F q2 = LoadQuads(base, index + 2), q3 = LoadQuads(base, index + 3);
  const F left01 = InterleaveLow(q0, q1), left23 = InterleaveLow(q2, q3);
  const F right01 = InterleaveHigh(q0, q1), right23 = InterleaveHigh(q2, q3);
  return {.upper_left = FirstHalves(left01, left23),
          .upper_right = FirstHalves(right01, right23),
          .lower_left = SecondHalves(left01, left23),
          .lower_right = SecondHalves(right01, right23)};
}

}  // namespace

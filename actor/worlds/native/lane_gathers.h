// SPDX-License-Identifier: Apache-2.0
// Gathers: each lane reads from its own place in an array. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/lanes.h"

namespace {

// at[0], at[1], at[stride] and at[stride + 1].
template <typename T>
SHOAL_INLINE __m128 LoadQuad(const T* at, int stride) {
  const __m128i upper = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(at));
  const __m128i lower = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(at + stride));
  return _mm_castsi128_ps(_mm_unpacklo_epi64(upper, lower));
}

// The quads at base + index[0], base + index[4], ... side by side.
template <typename T>
SHOAL_INLINE F LoadQuads(const T* base, int stride, const int32_t* index) {
  const __m128 first = LoadQuad(base + index[0], stride);
#if SHOAL_LANES == 4
  return {first};
#else
  const __m256 low =
      _mm256_insertf128_ps(_mm256_castps128_ps256(first), LoadQuad(base + index[4], stride), 1);
#if SHOAL_LANES == 8
  return {low};
#else
  const __m256 high =
      _mm256_insertf128_ps(_mm256_castps128_ps256(LoadQuad(base + index[8], stride)),
                           LoadQuad(base + index[12], stride), 1);
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

// base[at], base[at + 1], base[at + stride] and base[at + stride + 1] of each lane, as bits of
// either type. Lanes must hold indices that exist, used or not. Two loads of 64 bits for each lane
// and a transposition are faster than gather instructions.
template <typename T>
SHOAL_INLINE Quads GatherQuads(const T* base, int stride, I at) {
  static_assert(sizeof(T) == 4);
  alignas(64) int32_t index[kLanes];
  Store(index, at);
  const F q0 = LoadQuads(base, stride, index), q1 = LoadQuads(base, stride, index + 1);
  const F q2 = LoadQuads(base, stride, index + 2), q3 = LoadQuads(base, stride, index + 3);
  const F upper01 = InterleaveLow(q0, q1), upper23 = InterleaveLow(q2, q3);
  const F lower01 = InterleaveHigh(q0, q1), lower23 = InterleaveHigh(q2, q3);
  return {FirstHalves(upper01, upper23), SecondHalves(upper01, upper23),
          FirstHalves(lower01, lower23), SecondHalves(lower01, lower23)};
}

}  // namespace

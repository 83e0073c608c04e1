// SPDX-License-Identifier: Apache-2.0
// Reads from one address for each lane. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/lanes.h"

namespace {

// base[at] of each lane. Lanes must hold indices that exist, used or not.
SHOAL_INLINE I Gather(const int32_t* base, I at) {
#if SHOAL_LANES == 16
  return {_mm512_i32gather_epi32(at.v, base, 4)};
#elif SHOAL_LANES == 8
  return {_mm256_i32gather_epi32(base, at.v, 4)};
#else
  alignas(16) int32_t index[4];
  Store(index, at);
  return {_mm_setr_epi32(base[index[0]], base[index[1]], base[index[2]], base[index[3]])};
#endif
}
SHOAL_INLINE F Gather(const float* base, I at) {
#if SHOAL_LANES == 16
  return {_mm512_i32gather_ps(at.v, base, 4)};
#elif SHOAL_LANES == 8
  return {_mm256_i32gather_ps(base, at.v, 4)};
#else
  alignas(16) int32_t index[4];
  Store(index, at);
  return {_mm_setr_ps(base[index[0]], base[index[1]], base[index[2]], base[index[3]])};
#endif
}

// base[at] and base[at + 1] of each lane.
SHOAL_INLINE void GatherPairs(const int32_t* base, I at, I* first, I* second) {
#if SHOAL_LANES == 16
  const __m512i low = _mm512_i32gather_epi64(_mm512_castsi512_si256(at.v), base, 4);
  const __m512i high = _mm512_i32gather_epi64(_mm512_extracti64x4_epi64(at.v, 1), base, 4);
  const __m512i even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
  first->v = _mm512_permutex2var_epi32(low, even, high);
  second->v = _mm512_permutex2var_epi32(low, _mm512_add_epi32(even, _mm512_set1_epi32(1)), high);
#elif SHOAL_LANES == 8
  const auto* pairs = reinterpret_cast<const long long*>(base);
  const __m256 low =
      _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_castsi256_si128(at.v), 4));
  const __m256 high =
      _mm256_castsi256_ps(_mm256_i32gather_epi64(pairs, _mm256_extracti128_si256(at.v, 1), 4));
  // Lanes 0 1 4 5 | 2 3 6 7, then in order.
  const __m256 even = _mm256_shuffle_ps(low, high, _MM_SHUFFLE(2, 0, 2, 0));
  const __m256 odd = _mm256_shuffle_ps(low, high, _MM_SHUFFLE(3, 1, 3, 1));
  first->v = _mm256_permute4x64_epi64(_mm256_castps_si256(even), _MM_SHUFFLE(3, 1, 2, 0));
  second->v = _mm256_permute4x64_epi64(_mm256_castps_si256(odd), _MM_SHUFFLE(3, 1, 2, 0));
#else
  alignas(16) int32_t index[4];
  Store(index, at);
  const auto pair = [base, &index](int i) {
    return _mm_loadl_epi64(reinterpret_cast<const __m128i*>(base + index[i]));
  };
  const __m128 low = _mm_castsi128_ps(_mm_unpacklo_epi64(pair(0), pair(1)));
  const __m128 high = _mm_castsi128_ps(_mm_unpacklo_epi64(pair(2), pair(3)));
  first->v = _mm_castps_si128(_mm_shuffle_ps(low, high, _MM_SHUFFLE(2, 0, 2, 0)));
  second->v = _mm_castps_si128(_mm_shuffle_ps(low, high, _MM_SHUFFLE(3, 1, 3, 1)));
#endif
}

}  // namespace

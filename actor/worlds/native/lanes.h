// SPDX-License-Identifier: Apache-2.0
// Vectors of float and int32 for the kernels: 4 lanes (SSE2), 8 (AVX2) or 16
// (AVX-512).
//
// The including source defines SHOAL_LANES. Every operation rounds as IEEE 754
// says, so a lane's result does not depend on the number of lanes.
// Multiplication and addition must not be contracted
// (-ffp-contract=off). Everything here is local to the including source, because the same name
// stands for other instructions in other sources.
#pragma once

#include <immintrin.h>

#include <cstdint>

#if SHOAL_LANES == 16
#define SHOAL_V(sse2, avx2, avx512) avx512
#elif SHOAL_LANES == 8
#define SHOAL_V(sse2, avx2, avx512) avx2
#elif SHOAL_LANES == 4
#define SHOAL_V(sse2, avx2, avx512) sse2
#else
#error "SHOAL_LANES must be 4, 8 or 16"
#endif
#define SHOAL_INLINE inline __attribute__((always_inline))

namespace {

constexpr int kLanes = SHOAL_LANES;

struct F {
  SHOAL_V(__m128, __m256, __m512) v;
};
struct I {
  SHOAL_V(__m128i, __m256i, __m512i) v;
};
#if SHOAL_LANES == 16
struct M {
  __mmask16 v;
};
#else
struct M {
  SHOAL_V(__m128, __m256, ) v;
};
#endif

SHOAL_INLINE F Set(float x) {
  return {SHOAL_V(_mm_set1_ps(x), _mm256_set1_ps(x), _mm512_set1_ps(x))};
}
SHOAL_INLINE I Set(int32_t x) {
  return {SHOAL_V(_mm_set1_epi32(x), _mm256_set1_epi32(x), _mm512_set1_epi32(x))};
}
SHOAL_INLINE F Load(const float* p) {
  return {SHOAL_V(_mm_loadu_ps(p), _mm256_loadu_ps(p), _mm512_loadu_ps(p))};
}
SHOAL_INLINE void Store(float* p, F a) {
  SHOAL_V(_mm_storeu_ps(p, a.v), _mm256_storeu_ps(p, a.v), _mm512_storeu_ps(p, a.v));
}
SHOAL_INLINE I Load(const int32_t* p) {
  return {SHOAL_V(_mm_loadu_si128(reinterpret_cast<const __m128i*>(p)),
                  _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p)), _mm512_loadu_si512(p))};
}
SHOAL_INLINE void Store(int32_t* p, I a) {
  SHOAL_V(_mm_storeu_si128(reinterpret_cast<__m128i*>(p), a.v),
          _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a.v), _mm512_storeu_si512(p, a.v));
}

SHOAL_INLINE F operator+(F a, F b) {
  return {SHOAL_V(_mm_add_ps, _mm256_add_ps, _mm512_add_ps)(a.v, b.v)};
}
SHOAL_INLINE F operator-(F a, F b) {
  return {SHOAL_V(_mm_sub_ps, _mm256_sub_ps, _mm512_sub_ps)(a.v, b.v)};
}
SHOAL_INLINE F operator*(F a, F b) {
  return {SHOAL_V(_mm_mul_ps, _mm256_mul_ps, _mm512_mul_ps)(a.v, b.v)};
}
SHOAL_INLINE F operator/(F a, F b) {
  return {SHOAL_V(_mm_div_ps, _mm256_div_ps, _mm512_div_ps)(a.v, b.v)};
}
SHOAL_INLINE F Sqrt(F a) { return {SHOAL_V(_mm_sqrt_ps, _mm256_sqrt_ps, _mm512_sqrt_ps)(a.v)}; }
// Minimum and maximum. If either argument is not a number, the result is `b`.
SHOAL_INLINE F Min(F a, F b) {
  return {SHOAL_V(_mm_min_ps, _mm256_min_ps, _mm512_min_ps)(a.v, b.v)};
}
SHOAL_INLINE F Max(F a, F b) {
  return {SHOAL_V(_mm_max_ps, _mm256_max_ps, _mm512_max_ps)(a.v, b.v)};
}

SHOAL_INLINE I operator+(I a, I b) {
  return {SHOAL_V(_mm_add_epi32, _mm256_add_epi32, _mm512_add_epi32)(a.v, b.v)};
}
SHOAL_INLINE I operator-(I a, I b) {
  return {SHOAL_V(_mm_sub_epi32, _mm256_sub_epi32, _mm512_sub_epi32)(a.v, b.v)};
}
// Low 32 bits of the product.
SHOAL_INLINE I operator*(I a, I b) {
#if SHOAL_LANES == 4  // SSE2 multiplies every second lane
  const __m128i even = _mm_mul_epu32(a.v, b.v);
  const __m128i odd = _mm_mul_epu32(_mm_srli_si128(a.v, 4), _mm_srli_si128(b.v, 4));
  return {_mm_unpacklo_epi32(_mm_shuffle_epi32(even, _MM_SHUFFLE(0, 0, 2, 0)),
                             _mm_shuffle_epi32(odd, _MM_SHUFFLE(0, 0, 2, 0)))};
#else
  return {SHOAL_V(, _mm256_mullo_epi32, _mm512_mullo_epi32)(a.v, b.v)};
#endif
}
SHOAL_INLINE I operator&(I a, I b) {
  return {SHOAL_V(_mm_and_si128, _mm256_and_si256, _mm512_and_si512)(a.v, b.v)};
}
SHOAL_INLINE I operator|(I a, I b) {
  return {SHOAL_V(_mm_or_si128, _mm256_or_si256, _mm512_or_si512)(a.v, b.v)};
}
template <int kBits>
SHOAL_INLINE I ShiftLeft(I a) {
  return {SHOAL_V(_mm_slli_epi32, _mm256_slli_epi32, _mm512_slli_epi32)(a.v, kBits)};
}
// Logical.
template <int kBits>
SHOAL_INLINE I ShiftRight(I a) {
  return {SHOAL_V(_mm_srli_epi32, _mm256_srli_epi32, _mm512_srli_epi32)(a.v, kBits)};
}
// Each lane as two unsigned 16-bit numbers.
SHOAL_INLINE I Multiply16(I a, I b) {
  return {SHOAL_V(_mm_mullo_epi16, _mm256_mullo_epi16, _mm512_mullo_epi16)(a.v, b.v)};
}
SHOAL_INLINE I Add16(I a, I b) {
  return {SHOAL_V(_mm_add_epi16, _mm256_add_epi16, _mm512_add_epi16)(a.v, b.v)};
}
SHOAL_INLINE I Subtract16(I a, I b) {
  return {SHOAL_V(_mm_sub_epi16, _mm256_sub_epi16, _mm512_sub_epi16)(a.v, b.v)};
}
template <int kBits>
SHOAL_INLINE I ShiftRight16(I a) {
  return {SHOAL_V(_mm_srli_epi16, _mm256_srli_epi16, _mm512_srli_epi16)(a.v, kBits)};
}

SHOAL_INLINE I Truncate(F a) {
  return {SHOAL_V(_mm_cvttps_epi32, _mm256_cvttps_epi32, _mm512_cvttps_epi32)(a.v)};
}
SHOAL_INLINE F ToFloat(I a) {
  return {SHOAL_V(_mm_cvtepi32_ps, _mm256_cvtepi32_ps, _mm512_cvtepi32_ps)(a.v)};
}
SHOAL_INLINE I Bits(F a) {
  return {SHOAL_V(_mm_castps_si128, _mm256_castps_si256, _mm512_castps_si512)(a.v)};
}
SHOAL_INLINE F FromBits(I a) {
  return {SHOAL_V(_mm_castsi128_ps, _mm256_castsi256_ps, _mm512_castsi512_ps)(a.v)};
}

#if SHOAL_LANES == 16
SHOAL_INLINE M operator>=(F a, F b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GE_OQ)}; }
SHOAL_INLINE M operator>(F a, F b) { return {_mm512_cmp_ps_mask(a.v, b.v, _CMP_GT_OQ)}; }
SHOAL_INLINE M operator==(I a, I b) { return {_mm512_cmpeq_epi32_mask(a.v, b.v)}; }
SHOAL_INLINE M operator>(I a, I b) { return {_mm512_cmpgt_epi32_mask(a.v, b.v)}; }
SHOAL_INLINE M operator&(M a, M b) { return {static_cast<__mmask16>(a.v & b.v)}; }
SHOAL_INLINE M operator|(M a, M b) { return {static_cast<__mmask16>(a.v | b.v)}; }
// a and not b.
SHOAL_INLINE M Without(M a, M b) { return {static_cast<__mmask16>(a.v & ~b.v)}; }
SHOAL_INLINE uint32_t LaneBits(M a) { return a.v; }
SHOAL_INLINE F Select(M m, F yes, F no) { return {_mm512_mask_blend_ps(m.v, no.v, yes.v)}; }
SHOAL_INLINE I Select(M m, I yes, I no) { return {_mm512_mask_blend_epi32(m.v, no.v, yes.v)}; }
#else
#if SHOAL_LANES == 8
SHOAL_INLINE M operator>=(F a, F b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ)}; }
SHOAL_INLINE M operator>(F a, F b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
#else
SHOAL_INLINE M operator>=(F a, F b) { return {_mm_cmpge_ps(a.v, b.v)}; }
SHOAL_INLINE M operator>(F a, F b) { return {_mm_cmpgt_ps(a.v, b.v)}; }
#endif
SHOAL_INLINE M operator==(I a, I b) {
  return {FromBits({SHOAL_V(_mm_cmpeq_epi32, _mm256_cmpeq_epi32, )(a.v, b.v)}).v};
}
SHOAL_INLINE M operator>(I a, I b) {
  return {FromBits({SHOAL_V(_mm_cmpgt_epi32, _mm256_cmpgt_epi32, )(a.v, b.v)}).v};
}
SHOAL_INLINE M operator&(M a, M b) { return {SHOAL_V(_mm_and_ps, _mm256_and_ps, )(a.v, b.v)}; }
SHOAL_INLINE M operator|(M a, M b) { return {SHOAL_V(_mm_or_ps, _mm256_or_ps, )(a.v, b.v)}; }
SHOAL_INLINE M Without(M a, M b) { return {SHOAL_V(_mm_andnot_ps, _mm256_andnot_ps, )(b.v, a.v)}; }
SHOAL_INLINE uint32_t LaneBits(M a) {
  return static_cast<uint32_t>(SHOAL_V(_mm_movemask_ps, _mm256_movemask_ps, )(a.v));
}
SHOAL_INLINE F Select(M m, F yes, F no) {
#if SHOAL_LANES == 8
  return {_mm256_blendv_ps(no.v, yes.v, m.v)};
#else
  return {_mm_or_ps(_mm_and_ps(m.v, yes.v), _mm_andnot_ps(m.v, no.v))};
#endif
}
SHOAL_INLINE I Select(M m, I yes, I no) { return Bits(Select(m, FromBits(yes), FromBits(no))); }
#endif
SHOAL_INLINE bool Any(M a) { return LaneBits(a) != 0; }

SHOAL_INLINE F Abs(F a) { return FromBits(Bits(a) & Set(int32_t{0x7fffffff})); }
SHOAL_INLINE I Min(I a, I b) { return Select(a > b, b, a); }
SHOAL_INLINE I Max(I a, I b) { return Select(a > b, a, b); }

// Largest whole number that is not above a, for |a| < 2^31.
SHOAL_INLINE I Floor(F a) {
  const I near = Truncate(a);
  return near - Select(ToFloat(near) > a, Set(int32_t{1}), Set(int32_t{0}));
}

// Index of the lowest lane of a mask that has one.
SHOAL_INLINE int FirstLane(M m) { return __builtin_ctz(LaneBits(m)); }

}  // namespace

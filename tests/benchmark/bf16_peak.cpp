// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/bf16_peak.h"

#include <immintrin.h>

#include <cstdint>

#include "common/base/check.h"

namespace shoal::bench {
namespace {

// More than latency times throughput of the instruction on any CPU, so that no sum waits for its
// previous result.
constexpr int kSums = 16;
constexpr int kLanes = 16;                                  // f32 sums of a register
constexpr double kBf16Operations = kSums * kLanes * 2 * 2;  // of a round: two products a lane
constexpr double kF32Operations = kSums * kLanes * 2;

volatile float sink;  // where results go, so that the loops are not left out

int64_t Rounds(double operations, double of_a_round) {
  return int64_t(operations / of_a_round) + 1;
}

// Each dot product is x - x, so that the sums stay 0.
__attribute__((target("avx512f,avx512bw,avx512vl,avx512bf16"))) void Bf16Rounds(int64_t rounds) {
  const __m512bh ones = _mm512_cvtne2ps_pbh(_mm512_set1_ps(1), _mm512_set1_ps(1));
  // Pairs of neighbours: (1, -1).
  const __m512bh signs = (__m512bh)_mm512_set1_epi32(int32_t(0xbf803f80));
  __m512 sums[kSums];
  for (__m512& sum : sums) sum = _mm512_setzero_ps();
  for (int64_t i = 0; i < rounds; ++i) {
#pragma GCC unroll 16
    for (int s = 0; s < kSums; ++s) sums[s] = _mm512_dpbf16_ps(sums[s], ones, signs);
  }
  for (int s = 1; s < kSums; ++s) sums[0] += sums[s];
  float lanes[kLanes];
  _mm512_storeu_ps(lanes, sums[0]);
  sink = lanes[0];
}

__attribute__((target("avx512f"))) void F32Rounds(int64_t rounds) {
  const __m512 half = _mm512_set1_ps(0.5f), quarter = _mm512_set1_ps(0.25f);
  __m512 sums[kSums];
  for (__m512& sum : sums) sum = quarter;
  for (int64_t i = 0; i < rounds; ++i) {
#pragma GCC unroll 16
    for (int s = 0; s < kSums; ++s) sums[s] = _mm512_fmadd_ps(sums[s], half, quarter);
  }
  for (int s = 1; s < kSums; ++s) sums[0] += sums[s];
  float lanes[kLanes];
  _mm512_storeu_ps(lanes, sums[0]);
  sink = lanes[0];
}

}  // namespace

bool HasBf16Peak() {
  return __builtin_cpu_supports("avx512bf16") && __builtin_cpu_supports("avx512bw") &&
         __builtin_cpu_supports("avx512vl");
}

void RunAtBf16Peak(double operations) {
  CHECK(HasBf16Peak());
  Bf16Rounds(Rounds(operations, kBf16Operations));
}

void RunAtF32Peak(double operations) {
  CHECK(HasBf16Peak());
  F32Rounds(Rounds(operations, kF32Operations));
}

}  // namespace shoal::bench

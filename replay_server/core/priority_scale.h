// SPDX-License-Identifier: Apache-2.0
// Weights of prioritised sampling (Eq. 33 of docs/algorithm.md). The error of a sample becomes a
// whole number, so that sums of weights are exact:
//
//   proportional:  p = |e| + 1e-6       (Schaul et al. 2016, arXiv:1511.05952)
//   LAP:           p = max(|e|, 1)      (Fujimoto et al. 2020, arXiv:2007.06049)
//   weight = p^a 2^20, rounded, at least 1 and at most 2^34
//
// p^a is computed with multiplications and square roots, which IEEE 754 rounds exactly. The same
// error therefore has the same weight on every machine.
#pragma once

#include <cstdint>

namespace shoal::replay {

enum class PriorityKind { kProportional, kLap };

class PriorityScale {
 public:
  static constexpr uint64_t kOne = uint64_t{1} << 20;   // weight of p = 1
  static constexpr uint64_t kMost = uint64_t{1} << 34;  // a billion of them fit in 64 bits

  // exponent: a, in [0, 1]; rounded to a multiple of 2^-20.
  PriorityScale(PriorityKind kind, double exponent);

  // `error`: finite and at least 0.
  uint64_t WeightOf(float error) const;

 private:
  const PriorityKind kind_;
  const uint32_t exponent_;  // a 2^20
};

}  // namespace shoal::replay

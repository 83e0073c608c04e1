// SPDX-License-Identifier: Apache-2.0
// Numbers that both sides of a comparison compute, so that recordings need not contain the numbers.
// The functions must give the same numbers as tests/comparison/shared_numbers.py.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace shoal {

// Numbers in [0, 1), exact in double: splitmix64 of fnv1a(name) + index.
inline std::vector<double> SharedUniform(const std::string& name, size_t count) {
  uint64_t first = 0xcbf29ce484222325;
  for (const char c : name) first = (first ^ uint8_t(c)) * 0x100000001b3;
  std::vector<double> numbers;
  for (size_t i = 0; i < count; ++i) {
    uint64_t x = (first + i) * 0x9e3779b97f4a7c15;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
    x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
    x ^= x >> 31;
    numbers.push_back(double(x >> 11) * 0x1p-53);
  }
  return numbers;
}

// Fills `out` with numbers in [-scale, scale), rounded to f32 once.
template <class Out>
void FillSymmetric(const std::string& name, double scale, Out&& out) {
  const std::vector<double> numbers = SharedUniform(name, out.size());
  std::ranges::transform(numbers, out.begin(),
                         [&](double u) { return float((2 * u - 1) * scale); });
}

// Fills `out` with numbers in 0..255.
template <class Out>
void FillBytes(const std::string& name, Out&& out) {
  const std::vector<double> numbers = SharedUniform(name, out.size());
  std::ranges::transform(numbers, out.begin(), [](double u) { return uint8_t(256 * u); });
}

}  // namespace shoal

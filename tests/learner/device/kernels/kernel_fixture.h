// SPDX-License-Identifier: Apache-2.0
// Runs kernels on the host. Each array is an allocation of its exact size, so the address sanitizer
// finds accesses beyond it; results hold invalid numbers before.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <deque>
#include <limits>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "learner/device/kernels/host_block.h"
#include "learner/device/kernels/numbers.h"

namespace shoal::learner::kernels {

class KernelTest : public testing::Test {
 protected:
  void TearDown() override {
    if (HasFailure()) ADD_FAILURE() << "repeat with --gtest_random_seed=" << seed_;
  }

  // n fresh random numbers in [low, high].
  std::vector<float> Random(size_t n, double low = -1, double high = 1) {
    std::vector<float> values(n);
    for (float& value : values) value = float(random_.Uniform(low, high));
    return values;
  }

  // A copy of the values.
  template <class T>
  T* In(const std::vector<T>& values) {
    T* memory = Out<T>(values.size());
    if (!values.empty()) std::memcpy(memory, values.data(), values.size() * sizeof(T));
    return memory;
  }
  // n invalid numbers.
  template <class T = float>
  T* Out(size_t n) {
    auto& bytes = arrays_.emplace_back(n * sizeof(T), std::byte{0xff});
    return reinterpret_cast<T*>(bytes.data());
  }
  int32_t* Counters(size_t n) { return In(std::vector<int32_t>(n, 0)); }

  // Runs the kernel with both orders of blocks and threads, and expects equal results: a kernel
  // whose results depend on the order lacks the end of a phase.
  template <class Kernel>
  void Run(const Kernel& kernel) {
    const auto before = arrays_;
    RunOnHost(kernel, HostOrder::kForward);
    const auto forward = arrays_;
    for (size_t i = 0; i < arrays_.size(); ++i) std::ranges::copy(before[i], arrays_[i].begin());
    RunOnHost(kernel, HostOrder::kBackward);
    EXPECT_TRUE(forward == arrays_) << "results depend on the order of threads";
  }

 private:
  const int seed_ = testing::UnitTest::GetInstance()->random_seed();
  shoal::Random random_{uint64_t(seed_) + 1};
  std::deque<std::vector<std::byte>> arrays_;
};

// Expects |actual - expected| <= tolerance * the largest |expected|.
inline void ExpectClose(const float* actual, std::span<const float> expected, double tolerance) {
  double scale = 0;
  for (const float value : expected) scale = std::max(scale, double(std::abs(value)));
  for (size_t i = 0; i < expected.size(); ++i) {
    ASSERT_LE(std::abs(double(actual[i]) - expected[i]), tolerance * scale)
        << "number " << i << ": " << actual[i] << ", expected " << expected[i];
  }
}

inline std::vector<float> FromBf16s(const uint16_t* values, size_t n) {
  std::vector<float> floats;
  for (size_t i = 0; i < n; ++i) floats.push_back(FromBf16(values[i]));
  return floats;
}

}  // namespace shoal::learner::kernels

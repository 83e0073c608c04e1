// SPDX-License-Identifier: Apache-2.0
// Common parts of tests of single layers: memories filled from and read into plain arrays,
// parameters with random values, both precisions.
#pragma once

#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/nn/layer_context.h"
#include "common/nn/op.h"
#include "common/nn/parallel.h"
#include "common/nn/parameter_set.h"
#include "common/nn/primitive_descs.h"
#include "tests/common/nn/gradient_check.h"

namespace shoal::nn {

inline void FillMemory(const reference::Values& values, const dnnl::memory& memory) {
  const dnnl::memory plain = MakeMemory(PlainF32(DimsOf(memory)));
  const std::vector<float> floats = ToFloats(values);
  ASSERT_EQ(floats.size() * sizeof(float), plain.get_desc().get_size());
  std::memcpy(plain.get_data_handle(), floats.data(), floats.size() * sizeof(float));
  Op::Reorder(plain, memory, std::make_shared<Scratchpad>()).Run();
}

inline std::vector<float> ReadMemory(const dnnl::memory& memory) {
  const dnnl::memory plain = MakeMemory(PlainF32(DimsOf(memory)));
  Op::Reorder(memory, plain, std::make_shared<Scratchpad>()).Run();
  const float* values = static_cast<const float*>(plain.get_data_handle());
  return {values, values + plain.get_desc().get_size() / sizeof(float)};
}

inline size_t Count(const Parameter& parameter) {
  size_t count = 1;
  for (const int64_t size : parameter.shape()) count *= size_t(size);
  return count;
}

inline std::span<const float> GradientOf(ParameterSet& set, std::string_view name) {
  const Parameter parameter = set.Find(name);
  return {parameter.gradient(), Count(parameter)};
}

// Sets every parameter, also biases and norms, to random values times `scale`, so that sums stay
// near 1.
inline void Randomise(ParameterSet* set, uint64_t key, double scale) {
  const reference::Values values = RandomValues(size_t(set->size()), key);
  for (size_t i = 0; i < values.size(); ++i) set->values()[i] = float(values[i] * scale);
}

class LayerTest : public testing::TestWithParam<Precision> {
 protected:
  void SetUp() override {
    if (GetParam() == Precision::kBf16 &&
        ChoosePrecision("auto", /*pixels=*/true) != Precision::kBf16) {
      GTEST_SKIP() << "this CPU has no bf16 arithmetic";
    }
  }

  LayerContext Context(ParameterSet& parameters, int batch, bool training = true) const {
    return {&parameters, GetParam(), batch, training, std::make_shared<Scratchpad>()};
  }

  const ThreadScope one_thread_{1};
};

#define INSTANTIATE_PRECISIONS(Suite)                                                            \
  INSTANTIATE_TEST_SUITE_P(Precision, Suite, testing::Values(Precision::kF32, Precision::kBf16), \
                           [](const auto& test) { return std::string(ToString(test.param)); })

}  // namespace shoal::nn

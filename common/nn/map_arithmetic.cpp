// SPDX-License-Identifier: Apache-2.0
#include "common/nn/map_arithmetic.h"

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/nn/bf16.h"
#include "common/nn/parallel.h"
#include "common/nn/primitive_descs.h"
#include "common/nn/relu_mask.h"

namespace shoal::nn {
namespace {

inline float Positive(float value) { return value < 0 ? 0.f : value; }

template <class T>
[[gnu::always_inline]] inline void ReluLoop(int64_t n, T* y) {
  for (int64_t i = 0; i < n; ++i) Store(Positive(ToFloat(y[i])), y + i);
}

template <class T>
[[gnu::always_inline]] inline void AddLoop(const T* x, int64_t n, T* y) {
  for (int64_t i = 0; i < n; ++i) Store(ToFloat(y[i]) + ToFloat(x[i]), y + i);
}

template <class T>
[[gnu::always_inline]] inline void AddReluLoop(const T* x, int64_t n, T* y) {
  for (int64_t i = 0; i < n; ++i) Store(Positive(ToFloat(y[i]) + ToFloat(x[i])), y + i);
}

SHOAL_CPU_CLONES void ReluRange(int64_t n, float* __restrict y) { ReluLoop(n, y); }
SHOAL_CPU_CLONES void ReluRange(int64_t n, uint16_t* __restrict y) { ReluLoop(n, y); }
SHOAL_CPU_CLONES void AddRange(const float* __restrict x, int64_t n, float* __restrict y) {
  AddLoop(x, n, y);
}
SHOAL_CPU_CLONES void AddRange(const uint16_t* __restrict x, int64_t n, uint16_t* __restrict y) {
  AddLoop(x, n, y);
}
SHOAL_CPU_CLONES void AddReluRange(const float* __restrict x, int64_t n, float* __restrict y) {
  AddReluLoop(x, n, y);
}
SHOAL_CPU_CLONES void AddReluRange(const uint16_t* __restrict x, int64_t n,
                                   uint16_t* __restrict y) {
  AddReluLoop(x, n, y);
}

// Calls body(values of y, values of x, number of values) in the type that both have.
template <class Body>
void WithArrays(const dnnl::memory& x, const dnnl::memory& y, const Body& body) {
  const dnnl::memory::desc desc = y.get_desc();
  CHECK(x.get_desc() == desc) << "maps of two layouts";
  if (TypeOf(desc) == dnnl::memory::data_type::bf16) {
    body(static_cast<const uint16_t*>(x.get_data_handle()),
         int64_t(desc.get_size() / sizeof(uint16_t)), static_cast<uint16_t*>(y.get_data_handle()));
  } else {
    CHECK(TypeOf(desc) == dnnl::memory::data_type::f32);
    body(static_cast<const float*>(x.get_data_handle()), int64_t(desc.get_size() / sizeof(float)),
         static_cast<float*>(y.get_data_handle()));
  }
}

}  // namespace

void Relu(const dnnl::memory& y) {
  WithArrays(y, y, [](const auto*, int64_t n, auto* values) {
    ParallelForValues(n, [&](int64_t first, int64_t count) { ReluRange(count, values + first); });
  });
}

void Add(const dnnl::memory& x, const dnnl::memory& y) {
  WithArrays(x, y, [](const auto* from, int64_t n, auto* to) {
    ParallelForValues(
        n, [&](int64_t first, int64_t count) { AddRange(from + first, count, to + first); });
  });
}

void AddThenRelu(const dnnl::memory& x, const dnnl::memory& y) {
  WithArrays(x, y, [](const auto* from, int64_t n, auto* to) {
    ParallelForValues(
        n, [&](int64_t first, int64_t count) { AddReluRange(from + first, count, to + first); });
  });
}

void MaskWhereZero(const dnnl::memory& y, const dnnl::memory& dy) {
  WithArrays(y, dy, [](const auto* values, int64_t n, auto* gradient) {
    MaskWhereZero(values, n, gradient);
  });
}

}  // namespace shoal::nn

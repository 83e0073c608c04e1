#include "common/nn/adam.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"
#include "common/nn/tensor_counter.h"

namespace shoal::nn {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999, kEpsilon = 1e-8;
constexpr int kBlock = 4096;  // floats per unit of parallel work

// Arrays of one step, each of the set's size.
struct AdamArrays {
  const float *gradient, *m, *v, *value;
  float *next_m, *next_v, *next_value;
};

// rate: rate / (1 - b1^t). root_scale: 1 / sqrt(1 - b2^t).
SHOAL_CPU_CLONES void AdamRange(const AdamArrays& arrays, int64_t begin, int64_t end, float rate,
                                float root_scale) {
  constexpr float b1 = float(kBeta1), c1 = float(1 - kBeta1);
  constexpr float b2 = float(kBeta2), c2 = float(1 - kBeta2), epsilon = float(kEpsilon);
  const float* g = arrays.gradient;
  const float* m = arrays.m;
  const float* v = arrays.v;
  const float* w = arrays.value;
  float* next_m = arrays.next_m;
  float* next_v = arrays.next_v;
  float* next_w = arrays.next_value;
#pragma omp simd
  for (int64_t i = begin; i < end; ++i) {
    next_m[i] = b1 * m[i] + c1 * g[i];
    next_v[i] = b2 * v[i] + c2 * g[i] * g[i];
    next_w[i] = w[i] - rate * next_m[i] / (std::sqrt(next_v[i]) * root_scale + epsilon);
  }
}

SHOAL_CPU_CLONES void MoveRange(float tau, const float* __restrict online, int64_t n,
                                float* __restrict target) {
  for (int64_t i = 0; i < n; ++i) target[i] += tau * (online[i] - target[i]);
}

SHOAL_CPU_CLONES double SquaresOf(const float* values, int64_t n) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (int64_t i = 0; i < n; ++i) sum += double(values[i]) * double(values[i]);
  return sum;
}

int Blocks(int64_t n) { return int((n + kBlock - 1) / kBlock); }

}  // namespace

Adam::Adam(ParameterSet* parameters, double rate)
    : parameters_(parameters),
      rate_(rate),
      m_(size_t(parameters->size()), 0.f),
      v_(m_),
      next_m_(m_),
      next_v_(m_) {}

void Adam::Step() {
  ++steps_;
  const double t = double(steps_);
  const float rate = float(rate_ / (1 - std::pow(kBeta1, t)));
  const float root_scale = float(1 / std::sqrt(1 - std::pow(kBeta2, t)));
  const AdamArrays arrays{parameters_->gradients(),  m_.data(),      v_.data(),
                          parameters_->values(),     next_m_.data(), next_v_.data(),
                          parameters_->next_values()};
  const int64_t size = parameters_->size();
  ParallelFor(Blocks(size), [&](int begin, int end) {
    AdamRange(arrays, int64_t(begin) * kBlock, std::min(size, int64_t(end) * kBlock), rate,
              root_scale);
  });
  parameters_->Exchange();
  m_.swap(next_m_);
  v_.swap(next_v_);
}

void Adam::Undo() {
  CHECK(steps_ > 0);
  --steps_;
  parameters_->Exchange();
  m_.swap(next_m_);
  v_.swap(next_v_);
}

void Adam::Export(const std::string& group, TensorMap* tensors) const {
  parameters_->Export(m_.data(), "adam.m.", tensors);
  parameters_->Export(v_.data(), "adam.v.", tensors);
  ExportCounter("adam.steps." + group, steps_, tensors);
}

void Adam::Import(const TensorMap& tensors, const std::string& group, const std::string& source) {
  const uint64_t steps = ImportCounter(tensors, "adam.steps." + group, source);
  parameters_->Import(tensors, "adam.m.", source, next_m_.data());
  parameters_->Import(tensors, "adam.v.", source, next_v_.data());
  m_ = next_m_;
  v_ = next_v_;
  steps_ = steps;
}

void MoveTowards(float tau, const float* online, int64_t n, float* target) {
  ParallelFor(Blocks(n), [&](int begin, int end) {
    const int64_t first = int64_t(begin) * kBlock, last = std::min(n, int64_t(end) * kBlock);
    MoveRange(tau, online + first, last - first, target + first);
  });
}

double SumOfSquares(const float* values, int64_t n) { return SquaresOf(values, n); }

}  // namespace shoal::nn

#include "common/nn/adam.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"
#include "common/nn/tensor_words.h"

namespace shoal::nn {
namespace {

constexpr double kBeta1 = 0.9, kBeta2 = 0.999;
constexpr int kBlock = 4096;  // floats per unit of parallel work

// Arrays of one step, each of the set's trained size.
struct AdamArrays {
  const float *gradient, *m, *v, *value;
  float *next_m, *next_v, *next_value;
};

// rate: rate / (1 - b1^t). root_scale: 1 / sqrt(1 - b2^t).
struct StepSize {
  float rate, root_scale, epsilon;
};

SHOAL_CPU_CLONES void AdamRange(const AdamArrays& arrays, int64_t begin, int64_t end,
                                const StepSize& size) {
  constexpr float b1 = float(kBeta1), c1 = float(1 - kBeta1);
  constexpr float b2 = float(kBeta2), c2 = float(1 - kBeta2);
  const float rate = size.rate, root_scale = size.root_scale, epsilon = size.epsilon;
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

SHOAL_CPU_CLONES void ScaleRange(float factor, int64_t n, float* values) {
  for (int64_t i = 0; i < n; ++i) values[i] *= factor;
}

int Blocks(int64_t n) { return int((n + kBlock - 1) / kBlock); }

}  // namespace

Adam::Adam(std::vector<ParameterSet*> sets, const Options& options)
    : rate_(options.rate), epsilon_(options.epsilon), max_norm_(options.max_norm) {
  for (ParameterSet* set : sets) {
    const std::vector<float> zeros(size_t(set->trained_size()), 0.f);
    moments_.push_back({set, zeros, zeros, zeros, zeros});
  }
}

void Adam::Moments::Exchange() {
  set->Exchange();
  m.swap(next_m);
  v.swap(next_v);
}

std::vector<ParameterSet*> Adam::sets() const {
  std::vector<ParameterSet*> sets;
  for (const Moments& moments : moments_) sets.push_back(moments.set);
  return sets;
}

double Adam::GradientSquares() const {
  double squares = 0;
  for (const Moments& moments : moments_) {
    const ParameterSet& set = *moments.set;
    squares += SumOfSquares(set.gradients(), set.trained_size());
  }
  return squares;
}

void Adam::ClipGradients() {
  const double factor = max_norm_ / (std::sqrt(GradientSquares()) + 1e-6);
  if (factor >= 1) return;
  for (const Moments& moments : moments_) {
    ScaleRange(float(factor), moments.set->trained_size(), moments.set->gradients());
  }
}

void Adam::Step() {
  if (max_norm_ > 0) ClipGradients();
  ++steps_;
  const double t = double(steps_);
  const StepSize step{float(rate() / (1 - std::pow(kBeta1, t))),
                      float(1 / std::sqrt(1 - std::pow(kBeta2, t))), float(epsilon_)};
  for (Moments& moments : moments_) {
    ParameterSet& set = *moments.set;
    const AdamArrays arrays{set.gradients(),  moments.m.data(),      moments.v.data(),
                            set.values(),     moments.next_m.data(), moments.next_v.data(),
                            set.next_values()};
    const int64_t size = set.trained_size();
    ParallelFor(Blocks(size), [&](int begin, int end) {
      AdamRange(arrays, int64_t(begin) * kBlock, std::min(size, int64_t(end) * kBlock), step);
    });
    moments.Exchange();
  }
}

void Adam::Undo() {
  CHECK(steps_ > 0);
  --steps_;
  for (Moments& moments : moments_) moments.Exchange();
}

void Adam::Export(const std::string& group, TensorMap* tensors) const {
  for (const Moments& moments : moments_) {
    moments.set->ExportTrained(moments.m.data(), "adam.m.", tensors);
    moments.set->ExportTrained(moments.v.data(), "adam.v.", tensors);
  }
  ExportCounter("adam.steps." + group, steps_, tensors);
}

// Into the arrays that the next step would write, so that a refusal leaves the others as they are.
void Adam::Import(const TensorMap& tensors, const std::string& group, const std::string& source) {
  const uint64_t steps = ImportCounter(tensors, "adam.steps." + group, source);
  for (Moments& moments : moments_) {
    moments.set->ImportTrained(tensors, "adam.m.", source, moments.next_m.data());
    moments.set->ImportTrained(tensors, "adam.v.", source, moments.next_v.data());
  }
  for (Moments& moments : moments_) {
    moments.m = moments.next_m;
    moments.v = moments.next_v;
  }
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

// SPDX-License-Identifier: Apache-2.0
#include "common/nn/adam.h"

#include <algorithm>
#include <cmath>
#include <span>

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

SHOAL_CPU_CLONES void AddToSum(const float* values, int64_t n, float* sum) {
  for (int64_t i = 0; i < n; ++i) sum[i] += values[i];
}

int Blocks(int64_t n) { return int((n + kBlock - 1) / kBlock); }

// The mean of `arrays`, summed in their order, to mean[0..n), which may be one of them.
void Average(std::span<const float* const> arrays, int64_t n, float* mean) {
  float sum[kBlock];
  for (int64_t at = 0; at < n; at += kBlock) {
    const int64_t block = std::min<int64_t>(kBlock, n - at);
    std::copy_n(arrays[0] + at, block, sum);
    for (const float* array : arrays.subspan(1)) AddToSum(array + at, block, sum);
    ScaleRange(1.f / float(arrays.size()), block, sum);
    std::copy_n(sum, block, mean + at);
  }
}

}  // namespace

Adam::Adam(const std::vector<ParameterSet*>& sets, const Options& options, Replica* replica)
    : sets_(sets),
      replica_(replica != nullptr ? replica : &alone_),
      moments_(sets.size()),
      rate_(options.rate),
      epsilon_(options.epsilon),
      max_norm_(options.max_norm) {
  if (!KeepsMoments()) return;
  for (size_t s = 0; s < sets_.size(); ++s) {
    const std::vector<float> zeros(size_t(sets_[s]->trained_size()), 0.f);
    moments_[s] = {zeros, zeros, zeros, zeros};
  }
}

const std::vector<Adam*>& Adam::Peers() {
  if (peers_.empty()) peers_ = replica_->Peers(this);
  return peers_;
}

// Each to its own gradients, from those of all.
void Adam::AverageShares() {
  const std::vector<Adam*>& peers = Peers();
  replica_->Meet();
  std::vector<const float*> arrays(peers.size());
  for (size_t s = 0; s < sets_.size(); ++s) {
    const Replica::Share share = ShareOf(*sets_[s]);
    for (size_t r = 0; r < peers.size(); ++r) {
      arrays[r] = peers[r]->sets_[s]->gradients() + share.begin;
    }
    Average(arrays, share.end - share.begin, sets_[s]->gradients() + share.begin);
  }
}

double Adam::GatherGradients() {
  if (replica_->count() > 1) AverageShares();
  double squares = 0;
  for (const ParameterSet* set : sets_) {
    const Replica::Share share = ShareOf(*set);
    squares += SumOfSquares(set->gradients() + share.begin, share.end - share.begin);
  }
  squares_ = replica_->Means({squares})[0] * replica_->count();
  return *squares_;
}

void Adam::ClipGradients() {
  const double factor = max_norm_ / (std::sqrt(*squares_) + 1e-6);
  if (factor >= 1) return;
  for (ParameterSet* set : sets_) {
    const Replica::Share share = ShareOf(*set);
    ScaleRange(float(factor), share.end - share.begin, set->gradients() + share.begin);
  }
}

// What was stepped goes to the other replicas while it is in the cache.
void Adam::StepShare(size_t s) {
  const double t = double(steps_);
  const StepSize step{float(rate() / (1 - std::pow(kBeta1, t))),
                      float(1 / std::sqrt(1 - std::pow(kBeta2, t))), float(epsilon_)};
  ParameterSet& set = *sets_[s];
  Moments& moments = Peers()[0]->moments_[s];
  const AdamArrays arrays{set.gradients(),  moments.m.data(),      moments.v.data(),
                          set.values(),     moments.next_m.data(), moments.next_v.data(),
                          set.next_values()};
  const Replica::Share share = ShareOf(set);
  ParallelFor(Blocks(share.end - share.begin), [&](int begin, int end) {
    for (int block = begin; block < end; ++block) {
      const int64_t first = share.begin + int64_t(block) * kBlock;
      const int64_t last = std::min(share.end, first + kBlock);
      AdamRange(arrays, first, last, step);
      for (const Adam* peer : Peers()) {
        float* next = peer->sets_[s]->next_values();
        if (peer != this) std::copy_n(arrays.next_value + first, last - first, next + first);
      }
    }
  });
}

void Adam::Step() {
  if (!squares_ && (replica_->count() > 1 || max_norm_ > 0)) GatherGradients();
  if (max_norm_ > 0) ClipGradients();
  ++steps_;
  for (size_t s = 0; s < sets_.size(); ++s) StepShare(s);
  replica_->Meet();
  squares_.reset();
  Exchange();
}

void Adam::Exchange() {
  for (ParameterSet* set : sets_) set->Exchange();
  for (Moments& moments : moments_) {
    moments.m.swap(moments.next_m);
    moments.v.swap(moments.next_v);
  }
}

void Adam::Undo() {
  CHECK(steps_ > 0);
  --steps_;
  Exchange();
}

void Adam::Export(const std::string& group, TensorMap* tensors) const {
  for (size_t s = 0; KeepsMoments() && s < sets_.size(); ++s) {
    sets_[s]->ExportTrained(moments_[s].m.data(), "adam.m.", tensors);
    sets_[s]->ExportTrained(moments_[s].v.data(), "adam.v.", tensors);
  }
  ExportCounter("adam.steps." + group, steps_, tensors);
}

// Into the arrays that the next step would write, so that a refusal leaves the others as they are.
void Adam::Import(const TensorMap& tensors, const std::string& group, const std::string& source) {
  const uint64_t steps = ImportCounter(tensors, "adam.steps." + group, source);
  for (size_t s = 0; KeepsMoments() && s < sets_.size(); ++s) {
    sets_[s]->ImportTrained(tensors, "adam.m.", source, moments_[s].next_m.data());
    sets_[s]->ImportTrained(tensors, "adam.v.", source, moments_[s].next_v.data());
  }
  for (Moments& moments : moments_) {
    moments.m = moments.next_m;
    moments.v = moments.next_v;
  }
  steps_ = steps;
  squares_.reset();
}

void MoveTowards(float tau, const float* online, int64_t n, float* target) {
  ParallelFor(Blocks(n), [&](int begin, int end) {
    const int64_t first = int64_t(begin) * kBlock, last = std::min(n, int64_t(end) * kBlock);
    MoveRange(tau, online + first, last - first, target + first);
  });
}

double SumOfSquares(const float* values, int64_t n) { return SquaresOf(values, n); }

}  // namespace shoal::nn

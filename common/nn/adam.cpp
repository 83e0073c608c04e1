// SPDX-License-Identifier: Apache-2.0
#include "common/nn/adam.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"
#include "common/nn/module.h"
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
  constexpr float kB1 = float(kBeta1), kC1 = float(1 - kBeta1);
  constexpr float kB2 = float(kBeta2), kC2 = float(1 - kBeta2);
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
    next_m[i] = kB1 * m[i] + kC1 * g[i];
    next_v[i] = kB2 * v[i] + kC2 * g[i] * g[i];
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

SHOAL_CPU_CLONES void ScaleTo(float factor, const float* values, int64_t n, float* scaled) {
  for (int64_t i = 0; i < n; ++i) scaled[i] = factor * values[i];
}

SHOAL_CPU_CLONES void AddScaled(float factor, const float* values, int64_t n, float* sum) {
  for (int64_t i = 0; i < n; ++i) sum[i] += factor * values[i];
}

int Blocks(int64_t n) { return int((n + kBlock - 1) / kBlock); }

// The gradients of one replica, and their weight in the mean.
struct Weighted {
  float weight;
  const float* values;
};

// Writes the sum of weight * values, in the given order, to mean[0..n), which may be one of the
// arrays.
void Average(std::span<const Weighted> arrays, int64_t n, float* mean) {
  float sum[kBlock];
  for (int64_t at = 0; at < n; at += kBlock) {
    const int64_t block = std::min<int64_t>(kBlock, n - at);
    ScaleTo(arrays[0].weight, arrays[0].values + at, block, sum);
    for (const Weighted& array : arrays.subspan(1)) {
      AddScaled(array.weight, array.values + at, block, sum);
    }
    std::copy_n(sum, block, mean + at);
  }
}

}  // namespace

Adam::Adam(const std::vector<ParameterSet*>& sets, const Options& options, Replica* replica)
    : sets_(sets),
      options_(options),
      replica_(replica != nullptr ? replica : &alone_),
      shared_(replica_->Shared<Shared>([this] { return MakeShared(); })) {
  shared_->members.push_back(this);
}

Adam::Adam(const std::vector<ParameterSet*>& sets, const Options& options,
           const ModuleContext& context)
    : Adam(sets, options, context.replica) {}

std::shared_ptr<Adam::Shared> Adam::MakeShared() const {
  auto shared = std::make_shared<Shared>();
  for (const ParameterSet* set : sets_) {
    const std::vector<float> zeros(size_t(set->trained_size()), 0.f);
    shared->moments.push_back({{zeros, zeros}, {zeros, zeros}});
  }
  return shared;
}

// Each replica writes its share of the mean of all gradients to its own gradients.
void Adam::AverageShares() {
  const std::vector<Adam*>& peers = shared_->members;
  replica_->Meet();
  std::vector<Weighted> arrays(peers.size());
  for (size_t s = 0; s < sets_.size(); ++s) {
    const Replica::Share share = ShareOf(*sets_[s]);
    for (size_t r = 0; r < peers.size(); ++r) {
      arrays[r] = {float(replica_->WeightOf(int(r))),
                   peers[r]->sets_[s]->gradients() + share.begin};
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
  if (options_.max_norm <= 0) ComputeStep();
  squares_ = replica_->Sum(squares);
  return *squares_;
}

void Adam::ClipGradients() {
  const double factor = options_.max_norm / (std::sqrt(*squares_) + 1e-6);
  if (factor >= 1) return;
  for (ParameterSet* set : sets_) {
    const Replica::Share share = ShareOf(*set);
    ScaleRange(float(factor), share.end - share.begin, set->gradients() + share.begin);
  }
}

void Adam::ComputeStep() {
  for (size_t s = 0; s < sets_.size(); ++s) StepShare(s);
}

void Adam::StepShare(size_t s) {
  const double t = double(steps_ + 1);
  const StepSize step{float(rate() / (1 - std::pow(kBeta1, t))),
                      float(1 / std::sqrt(1 - std::pow(kBeta2, t))), float(options_.epsilon)};
  ParameterSet& set = *sets_[s];
  auto& [m, v] = shared_->moments[s];
  const size_t next = 1 - current_;
  const AdamArrays arrays{set.gradients(), m[current_].data(), v[current_].data(), set.values(),
                          m[next].data(),  v[next].data(),     set.next_values()};
  const Replica::Share share = ShareOf(set);
  ParallelFor(Blocks(share.end - share.begin), [&](int begin, int end) {
    AdamRange(arrays, share.begin + int64_t(begin) * kBlock,
              std::min(share.end, share.begin + int64_t(end) * kBlock), step);
  });
}

void Adam::Step() {
  if (!squares_) GatherGradients();
  if (options_.max_norm > 0) {
    ClipGradients();
    ComputeStep();
    replica_->Meet();
  }
  ++steps_;
  squares_.reset();
  Exchange();
}

void Adam::Exchange() {
  for (ParameterSet* set : sets_) set->Exchange();
  current_ = 1 - current_;
}

void Adam::Undo() {
  CHECK(steps_ > 0);
  --steps_;
  Exchange();
}

void Adam::Attach(std::unique_ptr<AdamMirror> mirror) {
  CHECK(!mirror_ && replica_->count() == 1);
  mirror_ = std::move(mirror);
  mirror_is_old_ = true;
}

void Adam::UseMirror() {
  CHECK(mirror_);
  if (mirror_is_old_) mirror_->Send(CurrentMoments(), steps_);
  mirror_is_old_ = false;
  host_is_old_ = true;
}

void Adam::FetchFromMirror() const {
  if (host_is_old_) steps_ = mirror_->Fetch(CurrentMoments());
  host_is_old_ = false;
}

std::vector<AdamMirror::Moments> Adam::CurrentMoments() const {
  std::vector<AdamMirror::Moments> moments;
  for (auto& [m, v] : shared_->moments) moments.push_back({m[current_].data(), v[current_].data()});
  return moments;
}

void Adam::Export(const std::string& group, TensorMap* tensors) const {
  if (mirror_) FetchFromMirror();
  for (size_t s = 0; s < sets_.size(); ++s) {
    const auto& [m, v] = shared_->moments[s];
    sets_[s]->ExportTrained(m[current_].data(), "adam.m.", tensors);
    sets_[s]->ExportTrained(v[current_].data(), "adam.v.", tensors);
  }
  ExportCounter("adam.steps." + group, steps_, tensors);
}

// Reads into the arrays that the next step would write, so that a refusal leaves the others
// unchanged.
void Adam::Import(const TensorMap& tensors, const std::string& group, const std::string& source) {
  const uint64_t steps = ImportCounter(tensors, "adam.steps." + group, source);
  const size_t next = 1 - current_;
  for (size_t s = 0; s < sets_.size(); ++s) {
    auto& [m, v] = shared_->moments[s];
    sets_[s]->ImportTrained(tensors, "adam.m.", source, m[next].data());
    sets_[s]->ImportTrained(tensors, "adam.v.", source, v[next].data());
  }
  for (auto& [m, v] : shared_->moments) {
    m[current_] = m[next];
    v[current_] = v[next];
  }
  steps_ = steps;
  squares_.reset();
  host_is_old_ = false;
  mirror_is_old_ = true;
}

void MoveTowards(float tau, const float* online, int64_t n, float* target) {
  ParallelFor(Blocks(n), [&](int begin, int end) {
    const int64_t first = int64_t(begin) * kBlock, last = std::min(n, int64_t(end) * kBlock);
    if (tau == 1) {  // without the rounding of the difference
      std::copy(online + first, online + last, target + first);
    } else {
      MoveRange(tau, online + first, last - first, target + first);
    }
  });
}

double SumOfSquares(const float* values, int64_t n) { return SquaresOf(values, n); }

}  // namespace shoal::nn

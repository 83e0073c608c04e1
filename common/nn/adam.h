// SPDX-License-Identifier: Apache-2.0
// Adam and the moving average of target networks, each one pass over whole parameter sets (Eq. 10
// and 9 of docs/algorithm.md).
//
//   m' = b1 m + (1 - b1) g            b1 = 0.9, b2 = 0.999
//   v' = b2 v + (1 - b2) g^2
//   w' = w - rate * (m' / (1 - b1^t)) / (sqrt(v' / (1 - b2^t)) + eps)
//
// Source: Kingma and Ba 2014, arXiv:1412.6980, algorithm 1.
//
// Each of N replicas steps its share (1/N) of the parameters, whose values all replicas use. The
// gradients of a share are averaged over replicas, weighted by their rows. Moments exist once.
//
// Threads: each pass is split over the current ThreadScope; results do not depend on its size.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/nn/parameter_set.h"
#include "common/nn/replica.h"

namespace shoal::nn {

struct ModuleContext;

// Optimiser of parameter sets that are trained by one loss. Borrows them. Of a replica: that of
// every other one has the same sets and calls the same functions in the same order.
class Adam {
 public:
  struct Options {
    double rate = 0;
    double epsilon = 1e-8;
    double max_norm = 0;  // a step scales gradients of a larger Euclidean norm down to it; 0: none
  };

  // Borrows the replica; null: alone.
  Adam(const std::vector<ParameterSet*>& sets, const Options& options, Replica* replica = nullptr);
  // Belongs to the replica of `context`, as the modules whose parameters it steps.
  Adam(const std::vector<ParameterSet*>& sets, const Options& options,
       const ModuleContext& context);
  Adam(const Adam&) = delete;
  Adam& operator=(const Adam&) = delete;

  // For the steps from now on: factor * Options::rate.
  void set_rate_factor(double factor) { rate_factor_ = factor; }
  double rate() const { return rate_ * rate_factor_; }

  // Averages the gradients over replicas, each of them in its own share (the rest stays its own),
  // and returns the sum of the squares of all. Call it once for each backward pass, even if no step
  // follows; a Step calls it if no call has been made since the last Step. Without a limit of the
  // norm this
  // computes the step as well, so that the replicas meet once for both; Step then applies it.
  double GatherGradients();
  // Applies the sets' gradients, clipped by max_norm / (norm + 1e-6) if the norm is limited, and
  // the statistics that the forward passes of these gradients measured.
  void Step();
  // Takes the last Step back exactly; at most once after each, and before the next GatherGradients.
  void Undo();
  uint64_t steps() const { return steps_; }

  // Tensors "adam.m.NAME", "adam.v.NAME" of every parameter and "adam.steps.`group`".
  void Export(const std::string& group, TensorMap* tensors) const;
  // Throws Error; nothing has changed then.
  void Import(const TensorMap& tensors, const std::string& group, const std::string& source);

 private:
  // Moments of one parameter set, in its layout: the current ones, and those that a step writes.
  struct Moments {
    std::array<std::vector<float>, 2> m, v;
  };
  // State that exists once for all replicas.
  struct Shared {
    std::vector<Adam*> members;    // by rank
    std::vector<Moments> moments;  // one for each set
  };
  std::shared_ptr<Shared> MakeShared() const;

  Replica::Share ShareOf(const ParameterSet& set) const {
    return replica_->ShareOf(set.trained_size());
  }
  void AverageShares();
  void ClipGradients();
  void ComputeStep();
  void StepShare(size_t set);
  void Exchange();

  const std::vector<ParameterSet*> sets_;
  Replica alone_;
  Replica* const replica_;
  const std::shared_ptr<Shared> shared_;
  size_t current_ = 0;             // of the two arrays of moments
  std::optional<double> squares_;  // of the gradients that were gathered for the next step

  double rate_, epsilon_, max_norm_;
  double rate_factor_ = 1;
  uint64_t steps_ = 0;
};

// target += tau * (online - target), n floats.
void MoveTowards(float tau, const float* online, int64_t n, float* target);

// Sum of squares in double, in an order that does not depend on the number of threads.
double SumOfSquares(const float* values, int64_t n);

}  // namespace shoal::nn

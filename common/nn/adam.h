// SPDX-License-Identifier: Apache-2.0
// Adam, and the moving average of target networks (Eq. 10 and 9 of docs/algorithm.md). Each of the
// two operations is one pass over whole parameter sets.
//
//   m' = b1 m + (1 - b1) g            b1 = 0.9, b2 = 0.999
//   v' = b2 v + (1 - b2) g^2
//   w' = w - rate * (m' / (1 - b1^t)) / (sqrt(v' / (1 - b2^t)) + eps)
//
// Source: Kingma and Ba 2014, arXiv:1412.6980, algorithm 1.
//
// Each of N replicas updates its share (1/N) of the parameters. All replicas use the same values.
// The gradients of a share are averaged over the replicas, with the replicas' numbers of rows as
// weights. The moments exist once for all replicas.
//
// Threads: each pass is split over the threads of the current ThreadScope. Results do not depend on
// the number of threads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/nn/parameter_mirror.h"
#include "common/nn/parameter_set.h"
#include "common/nn/replica.h"

namespace shoal::nn {

struct ModuleContext;

// Optimiser of parameter sets that are trained by one loss. Borrows the sets. With replicas, each
// replica has an optimiser of the same sets, and all replicas call the same functions in the same
// order.
class Adam {
 public:
  struct Options {
    double rate = 0;
    double epsilon = 1e-8;
    double max_norm = 0;  // limit for the Euclidean norm of the gradients; 0: no limit
  };

  // Borrows the replica; null if there are no replicas.
  Adam(const std::vector<ParameterSet*>& sets, const Options& options, Replica* replica = nullptr);
  // Uses the replica of `context`, which must also be the replica of the trained modules.
  Adam(const std::vector<ParameterSet*>& sets, const Options& options,
       const ModuleContext& context);
  Adam(const Adam&) = delete;
  Adam& operator=(const Adam&) = delete;

  // Sets the rate of all following steps to factor * Options::rate.
  void set_rate_factor(double factor) { rate_factor_ = factor; }
  double rate() const { return options_.rate * rate_factor_; }

  // Averages the gradients over replicas and returns the sum of their squares. Each replica
  // averages its own share; its other gradients do not change. Call it once for each backward pass,
  // even if no step follows. Step calls GatherGradients if there was no call since the last Step.
  // If the norm is not limited, GatherGradients also computes the step, and Step only applies the
  // step, which saves the replicas a barrier.
  double GatherGradients();
  // Applies the sets' gradients, and the statistics that their forward passes measured. If the norm
  // is limited, larger gradients are multiplied by max_norm / (norm + 1e-6).
  void Step();
  // Undoes the last Step exactly. Allowed at most once after each Step, and before the next
  // GatherGradients.
  void Undo();
  uint64_t steps() const {
    if (mirror_) FetchFromMirror();
    return steps_;
  }

  // For an engine that does not compute in host memory (parameter_mirror.h). It makes the steps, so
  // GatherGradients, Step and Undo are not used.
  void Attach(std::unique_ptr<AdamMirror> mirror);
  AdamMirror* mirror() const { return mirror_.get(); }  // null: no mirror
  // Sends newer moments of the host to the mirror, whose moments the engine will change. CHECKs
  // that there is a mirror.
  void UseMirror();
  const std::vector<ParameterSet*>& sets() const { return sets_; }
  const Options& options() const { return options_; }

  // Writes tensors "adam.m.NAME" and "adam.v.NAME" for every parameter, and "adam.steps.`group`".
  void Export(const std::string& group, TensorMap* tensors) const;
  // Reads the tensors that Export wrote. On an error, throws Error and changes nothing.
  void Import(const TensorMap& tensors, const std::string& group, const std::string& source);

 private:
  // Moments of one parameter set, in the layout of the set. Index current_: the current moments;
  // the other index: the moments that a step writes.
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
  // The current moments of all sets.
  std::vector<AdamMirror::Moments> CurrentMoments() const;
  void FetchFromMirror() const;

  const std::vector<ParameterSet*> sets_;
  const Options options_;
  Replica alone_;
  Replica* const replica_;
  const std::shared_ptr<Shared> shared_;
  size_t current_ = 0;             // index of the current moments
  std::optional<double> squares_;  // sum of squares of the gathered gradients

  double rate_factor_ = 1;
  mutable uint64_t steps_ = 0;
  std::unique_ptr<AdamMirror> mirror_;
  // Whether the other copy is newer.
  mutable bool host_is_old_ = false, mirror_is_old_ = false;
};

// target += tau * (online - target), n floats.
void MoveTowards(float tau, const float* online, int64_t n, float* target);

// Sum of squares in double, in an order that does not depend on the number of threads.
double SumOfSquares(const float* values, int64_t n);

}  // namespace shoal::nn

// Adam and the moving average of target networks, each one pass over whole parameter sets (Eq. 10
// and 9 of docs/algorithm.md).
//
//   m' = b1 m + (1 - b1) g            b1 = 0.9, b2 = 0.999
//   v' = b2 v + (1 - b2) g^2
//   w' = w - rate * (m' / (1 - b1^t)) / (sqrt(v' / (1 - b2^t)) + eps)
//
// Source: Kingma and Ba 2014, arXiv:1412.6980, algorithm 1.
// Threads: each pass is split over the current ThreadScope; results do not depend on its size.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/nn/parameter_set.h"

namespace shoal::nn {

// Optimiser of parameter sets that are trained by one loss. Borrows them.
class Adam {
 public:
  struct Options {
    double rate = 0;
    double epsilon = 1e-8;
    double max_norm = 0;  // a step scales gradients of a larger Euclidean norm down to it; 0: none
  };

  Adam(std::vector<ParameterSet*> sets, const Options& options);

  // What it steps.
  std::vector<ParameterSet*> sets() const;
  // For the steps from now on: factor * Options::rate.
  void set_rate_factor(double factor) { rate_factor_ = factor; }
  double rate() const { return rate_ * rate_factor_; }

  // Sum of the squares of all gradients.
  double GradientSquares() const;
  // Applies the sets' gradients, where they are to be clipped by max_norm / (norm + 1e-6), and the
  // statistics that the forward passes of these gradients measured.
  void Step();
  // Takes the last Step back exactly; at most once after each.
  void Undo();
  uint64_t steps() const { return steps_; }

  // Tensors "adam.m.NAME", "adam.v.NAME" of every parameter and "adam.steps.`group`".
  void Export(const std::string& group, TensorMap* tensors) const;
  // Throws Error; nothing has changed then.
  void Import(const TensorMap& tensors, const std::string& group, const std::string& source);

 private:
  // Of one set, in its layout.
  struct Moments {
    ParameterSet* set;
    std::vector<float> m, v;
    std::vector<float> next_m, next_v;  // where a step writes, then exchanged

    void Exchange();
  };

  std::vector<Moments> moments_;
  void ClipGradients();

  double rate_, epsilon_, max_norm_;
  double rate_factor_ = 1;
  uint64_t steps_ = 0;
};

// target += tau * (online - target), n floats.
void MoveTowards(float tau, const float* online, int64_t n, float* target);

// Sum of squares in double, in an order that does not depend on the number of threads.
double SumOfSquares(const float* values, int64_t n);

}  // namespace shoal::nn

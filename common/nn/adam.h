// Adam and the moving average of target networks, each one pass over a whole parameter set (Eq. 10
// and 9 of docs/algorithm.md).
//
//   m' = b1 m + (1 - b1) g            b1 = 0.9, b2 = 0.999, eps = 1e-8
//   v' = b2 v + (1 - b2) g^2
//   w' = w - rate * (m' / (1 - b1^t)) / (sqrt(v' / (1 - b2^t)) + eps)
//
// Source: Kingma and Ba 2014, arXiv:1412.6980, algorithm 1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/nn/parameter_set.h"

namespace shoal::nn {

// Optimiser of one parameter set, which it borrows.
class Adam {
 public:
  Adam(ParameterSet* parameters, double rate);

  // Applies the set's gradients.
  void Step();
  // Takes the last Step back exactly; at most once after each.
  void Undo();
  uint64_t steps() const { return steps_; }

  // Tensors "adam.m.NAME", "adam.v.NAME" of every parameter and "adam.steps.`group`".
  void Export(const std::string& group, TensorMap* tensors) const;
  // Throws Error; nothing has changed then.
  void Import(const TensorMap& tensors, const std::string& group, const std::string& source);

 private:
  ParameterSet* parameters_;
  double rate_;
  uint64_t steps_ = 0;
  std::vector<float> m_, v_;            // moments in the set's layout
  std::vector<float> next_m_, next_v_;  // where a step writes, then exchanged
};

// target += tau * (online - target), n floats.
void MoveTowards(float tau, const float* online, int64_t n, float* target);

// Sum of squares in double, in an order that does not depend on the number of threads.
double SumOfSquares(const float* values, int64_t n);

}  // namespace shoal::nn

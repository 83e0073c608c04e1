// SPDX-License-Identifier: Apache-2.0
// Scales by which the values of a latent agent are divided (Eq. 38 of docs/algorithm.md): the mean
// |reward| of the steps that were sampled since the networks were copied last.
#pragma once

#include <string>

#include "common/nn/safetensors.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

// A value type. One thread.
class RewardScales {
 public:
  // Adds the first steps of a batch's sequences.
  void Add(const BatchView& batch);
  // The scale of the critics becomes that of their targets, and the mean of the added steps that of
  // the critics. If all rewards were 0, the scale of the critics stays, because a scale near 0
  // would turn any later reward of the period into a huge value.
  void Advance();

  double critic() const { return critic_; }
  double target() const { return target_; }

  // Writes and reads tensor "critic.scales". Import throws Error that names the tensor if it is
  // missing or has another size.
  void Export(nn::TensorMap* tensors) const;
  void Import(const nn::TensorMap& tensors, const std::string& source);

 private:
  double critic_ = 1, target_ = 1;
  double sum_ = 0, count_ = 0;  // of |reward|
};

}  // namespace shoal::learner

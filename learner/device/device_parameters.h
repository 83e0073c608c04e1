// SPDX-License-Identifier: Apache-2.0
// Parameters and moments of optimisers in the memory of a device: the mirrors of ParameterSet and
// Adam (common/nn/parameter_mirror.h). Arrays have the order of a ParameterLayout.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/nn/adam.h"
#include "common/nn/parameter_mirror.h"
#include "common/nn/parameter_set.h"
#include "learner/device/kernels/state.h"
#include "learner/device/parameter_layout.h"
#include "learner/device/workspace.h"

namespace shoal::learner::device {

// Addresses of one parameter. rounded: the values in bf16, null if the workspace computes in f32.
// gradient: null for a running statistic, and if the set is not trained. next_value: of a statistic
// of a trained set; a forward pass writes it, and the optimiser's next step applies it.
struct Tensor {
  float* value;
  uint16_t* rounded;
  float* gradient;
  float* next_value;

  // The values in a type.
  const void* As(Type type) const { return device::As(type, value, rounded); }
};

// Every change of the values must change the rounded values as well. Send does.
class DeviceParameters final : public nn::ParameterMirror {
 public:
  // Borrows the workspace.
  DeviceParameters(Workspace* workspace, const ParameterLayout& layout, bool trained);

  // Returns the mirror of `set`, which must have one.
  static DeviceParameters& Of(const nn::ParameterSet& set);
  // Makes a mirror, with gradients if the set is trained, and attaches it to `set`. Returns it.
  static DeviceParameters& Attach(Workspace* workspace, const ParameterLayout& layout,
                                  nn::ParameterSet::Use use, const nn::ParameterSet& set);

  std::function<void(float* values)> BeginFetch() override;
  void Send(const float* values) override;

  const ParameterLayout& layout() const { return layout_; }
  Tensor Find(const std::string& name) const;
  float* values() const { return values_; }
  uint16_t* rounded() const { return rounded_; }
  float* gradients() const { return gradients_; }  // of the trained size
  // Statistics that the next step applies: the numbers beyond the trained size. Null if the set has
  // none, or is not trained.
  float* next_statistics() const { return next_statistics_; }

 private:
  Workspace* const workspace_;
  const ParameterLayout layout_;
  float* const values_;
  uint16_t* const rounded_;
  float* const gradients_;
  float* const next_statistics_;
};

class DeviceAdam final : public nn::AdamMirror {
 public:
  // Arrays of one set: moments, and former values and moments, from before the last step. Moments
  // have the trained size, values the whole one.
  struct Arrays {
    float *m, *v, *former_value, *former_m, *former_v;
  };

  // Borrows the workspace and the optimiser's sets, which must have mirrors.
  DeviceAdam(Workspace* workspace, const nn::Adam& optimiser);

  // Returns the mirror of `optimiser`, which must have one.
  static DeviceAdam& Of(const nn::Adam& optimiser);

  uint64_t Fetch(std::span<const Moments> sets) override;
  void Send(std::span<const Moments> sets, uint64_t steps) override;

  kernels::AdamState* state() const { return state_; }
  const std::vector<Arrays>& arrays() const { return arrays_; }  // one for each set

  const double* rate_factor = nullptr;  // null: 1
  const double* squares = nullptr;      // of the gradients that were gathered last
  double* const partials;               // of this sum (kernels::SumOfSquares)

 private:
  Workspace* const workspace_;
  std::vector<const DeviceParameters*> sets_;
  std::vector<Arrays> arrays_;
  kernels::AdamState* const state_;
};

}  // namespace shoal::learner::device

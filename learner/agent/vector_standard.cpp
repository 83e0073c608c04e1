// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/vector_standard.h"

#include <algorithm>
#include <cstring>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/vector_scale.h"

namespace shoal::learner {
namespace {

nn::NamedTensor Vector(const std::vector<float>& values) {
  nn::NamedTensor tensor{.dtype = "F32", .shape = {int64_t(values.size())}, .data = {}};
  tensor.data.resize(values.size() * sizeof(float));
  std::memcpy(tensor.data.data(), values.data(), tensor.data.size());
  return tensor;
}

}  // namespace

VectorStandard::VectorStandard(const LearnerConfig& learner, int vector_size, int privileged_size)
    : variance_floor_(float(learner.variance_floor)) {
  const bool on = learner.normalise_vectors;
  if (on && vector_size > 0) observed_.emplace(Part{RunningMoments(vector_size), {}, {}});
  if (on && privileged_size > 0) privileged_.emplace(Part{RunningMoments(privileged_size), {}, {}});
}

std::vector<float> VectorStandard::Variance(const Part& part) const {
  std::vector<float> variance = part.moments.Variance();
  for (float& v : variance) v = std::max(v, variance_floor_);
  return variance;
}

BatchView VectorStandard::Seen(const BatchView& batch) {
  const auto scale = [this](Part& part, std::span<float>* obs, std::span<float>* next_obs) {
    const nn::VectorScale moved(part.moments.Mean(), Variance(part));
    const auto apply = [&](std::span<float>* x, std::vector<float>* y) {
      y->resize(x->size());
      moved.Apply(x->data(), *y);
      *x = *y;
    };
    apply(obs, &part.obs);
    apply(next_obs, &part.next_obs);
  };
  BatchView seen = batch;
  if (observed_) scale(*observed_, &seen.obs_vector, &seen.next_obs_vector);
  if (privileged_) scale(*privileged_, &seen.obs_privileged, &seen.next_obs_privileged);
  return seen;
}

void VectorStandard::Add(const BatchView& batch) {
  if (observed_) observed_->moments.Add(batch.obs_vector);
  if (privileged_) privileged_->moments.Add(batch.obs_privileged);
}

void VectorStandard::ExportTo(nn::TensorMap* policy) const {
  if (!observed_) return;
  (*policy)[nn::kObservationMean] = Vector(observed_->moments.Mean());
  (*policy)[nn::kObservationVariance] = Vector(Variance(*observed_));
}

void VectorStandard::AddTo(AgentState* state) {
  const auto add = [state](RunningMoments* moments, const std::string& name) {
    state->Add([=](nn::TensorMap* tensors) { moments->Export(name, tensors); },
               [=](const nn::TensorMap& tensors, const std::string& source) {
                 moments->Import(tensors, name, source);
               });
  };
  if (observed_) add(&observed_->moments, "observation.moments");
  if (privileged_) add(&privileged_->moments, "privileged.moments");
}

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/vector_standard.h"

#include <cstring>
#include <vector>

#include "common/nn/actor_critic_plan.h"
#include "learner/agent/running_moments.h"

namespace shoal::learner {
namespace {

nn::NamedTensor Vector(const std::vector<float>& values) {
  nn::NamedTensor tensor{.dtype = "F32", .shape = {int64_t(values.size())}, .data = {}};
  tensor.data.resize(values.size() * sizeof(float));
  std::memcpy(tensor.data.data(), values.data(), tensor.data.size());
  return tensor;
}

}  // namespace

VectorStandard::VectorStandard(const LearnerConfig& learner, Engine* engine, int vector_size,
                               int privileged_size)
    : engine_(engine), variance_floor_(float(learner.variance_floor)) {
  if (!learner.normalise_vectors) return;
  if (vector_size > 0) observed_ = MakePart(vector_size);
  if (privileged_size > 0) privileged_ = MakePart(privileged_size);
}

VectorStandard::Part VectorStandard::MakePart(int size) const {
  return {engine_->NewMoments(size), engine_->NewArray(size), engine_->NewArray(size)};
}

Transitions VectorStandard::Seen(const Transitions& batch) {
  const auto scale = [this](const Part& part, Array* obs, Array* next_obs) {
    engine_->Standardise(*obs, part.moments, variance_floor_, part.obs);
    *obs = part.obs;
    if (!*next_obs) return;  // a rollout's minibatch has no next observations
    engine_->Standardise(*next_obs, part.moments, variance_floor_, part.next_obs);
    *next_obs = part.next_obs;
  };
  Transitions seen = batch;
  if (observed_) scale(*observed_, &seen.obs_vector, &seen.next_obs_vector);
  if (privileged_) scale(*privileged_, &seen.obs_privileged, &seen.next_obs_privileged);
  return seen;
}

void VectorStandard::Add(const BatchView& batch) {
  if (observed_) engine_->AddToMoments(batch.obs_vector, observed_->moments);
  if (privileged_) engine_->AddToMoments(batch.obs_privileged, privileged_->moments);
}

void VectorStandard::ExportTo(nn::TensorMap* policy) const {
  nn::PendingTensors pending;
  ExportTo(&pending);
  policy->merge(pending.Take());
}

void VectorStandard::ExportTo(nn::PendingTensors* policy) const {
  if (!observed_) return;
  policy->Add([floor = variance_floor_,
               read = engine_->CopyMoments(observed_->moments)](nn::TensorMap* arrived) {
    const std::vector<double> moments = read();
    (*arrived)[nn::kObservationMean] = Vector(MeanOf(moments));
    (*arrived)[nn::kObservationVariance] = Vector(VarianceOf(moments, floor));
  });
}

void VectorStandard::AddTo(AgentState* state) {
  if (observed_) AddTo(state, *observed_, "observation.moments");
  if (privileged_) AddTo(state, *privileged_, "privileged.moments");
}

void VectorStandard::AddTo(AgentState* state, const Part& part, const std::string& name) const {
  const Moments moments = part.moments;
  const auto width = size_t(moments.size()) / 2;
  state->Add(
      [=, engine = engine_](nn::TensorMap* tensors) {
        ExportMoments(engine->ReadMoments(moments), name, tensors);
      },
      [=, engine = engine_](const nn::TensorMap& tensors, const std::string& source) {
        engine->SetMoments(moments, ImportMoments(width, name, tensors, source));
      });
}

}  // namespace shoal::learner

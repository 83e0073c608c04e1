#include "learner/agent/vector_standard.h"

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

BatchView VectorStandard::Seen(const BatchView& batch) {
  if (!on_) return batch;
  const nn::VectorScale scale(moments_.Mean(), moments_.Variance());
  const auto apply = [&](std::span<const float> x, std::vector<float>* y) {
    y->resize(x.size());
    scale.Apply(x.data(), *y);
    return std::span(*y);
  };
  BatchView seen = batch;
  seen.obs_vector = apply(batch.obs_vector, &obs_);
  seen.next_obs_vector = apply(batch.next_obs_vector, &next_obs_);
  return seen;
}

void VectorStandard::Add(std::span<const float> vectors) {
  if (on_) moments_.Add(vectors);
}

void VectorStandard::ExportTo(nn::TensorMap* policy) const {
  if (!on_) return;
  (*policy)[nn::kObservationMean] = Vector(moments_.Mean());
  (*policy)[nn::kObservationVariance] = Vector(moments_.Variance());
}

void VectorStandard::AddTo(AgentState* state) {
  if (!on_) return;
  const std::string name = "observation.moments";
  state->Add([=, this](nn::TensorMap* tensors) { moments_.Export(name, tensors); },
             [=, this](const nn::TensorMap& tensors, const std::string& source) {
               moments_.Import(tensors, name, source);
             });
}

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "common/nn/policy.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "common/base/check.h"
#include "common/nn/actor_head.h"
#include "common/nn/encoder.h"
#include "common/nn/parallel.h"
#include "common/nn/parameter_set.h"
#include "common/nn/vector_scale.h"

namespace shoal::nn {
namespace {

// Encoder and actor built for one batch size.
struct SizedNetwork {
  SizedNetwork(const LayerContext& context, const NetworkPlan& encoder_plan,
               const ActorPlan& actor_plan) {
    if (!encoder_plan.layers().empty()) encoder.emplace(context, encoder_plan);
    actor.emplace(context, actor_plan, encoder ? encoder->features() : dnnl::memory(),
                  dnnl::memory());
    Refresh();
  }

  void Refresh() {
    if (encoder) encoder->Refresh();
    actor->Refresh();
  }

  std::optional<Encoder> encoder;
  std::optional<ActorHead> actor;
};

// One kind of policy: its parameters and the networks built on them.
struct Built {
  Built(const NetworkConfig& network, const ObservationSpec& spec, Precision compute_precision,
        ActorOutput output)
      : encoder(PlanEncoder(network, spec)),
        actor(PlanActor(network, spec, output)),
        precision(compute_precision),
        parameters(Parameters(), ParameterSet::Use::kBorrowing),
        scratchpad(std::make_shared<Scratchpad>()) {}

  std::vector<ParameterSpec> Parameters() const {
    std::vector<ParameterSpec> specs = encoder.Parameters();
    Append(actor.Parameters(), &specs);
    return specs;
  }

  // Built when a batch size first occurs and then kept, because an actor uses only one or two
  // sizes.
  SizedNetwork& ForBatch(int batch) {
    const auto found = networks.find(batch);
    if (found != networks.end()) return found->second;
    const LayerContext context{&parameters, precision, batch, /*training=*/false, scratchpad};
    return networks.try_emplace(batch, context, encoder, actor).first->second;
  }

  const NetworkPlan encoder;
  const ActorPlan actor;
  const Precision precision;
  std::shared_ptr<const void> loaded = nullptr;  // owns the weights that `parameters` borrow
  ParameterSet parameters;
  std::shared_ptr<Scratchpad> scratchpad;
  std::map<int, SizedNetwork> networks;
};

}  // namespace

void MeanActions(const PolicyOutput& output, std::span<float> actions) {
  CHECK(actions.size() == output.mean.size()) << actions.size() << " of " << output.mean.size();
  std::ranges::transform(output.mean, actions.begin(), [&](float mean) {
    return output.squashed ? std::tanh(mean) : std::clamp(mean, -1.f, 1.f);
  });
}

ActorOutput ActorOutputOf(const TensorViews& tensors, int action_size) {
  if (tensors.Find("actor.log_std")) return ActorOutput::kUnsquashed;
  const TensorView* bias = tensors.Find("actor.mlp.output.bias");
  const bool deterministic = bias != nullptr && bias->shape == std::vector<int64_t>{action_size};
  return deterministic ? ActorOutput::kDeterministic : ActorOutput::kGaussian;
}

struct Policy::Impl {
  // `owner` keeps the memory of the views alive.
  void Load(const TensorViews& tensors, std::shared_ptr<const void> owner,
            const std::string& source);

  std::unique_ptr<Built> Build(ActorOutput output) const {
    return std::make_unique<Built>(network, spec, precision, output);
  }

  const NetworkConfig network;
  const ObservationSpec spec;
  const Precision precision;
  const int max_batch;
  const int threads = Threads();
  std::unique_ptr<Built> built = nullptr;
  std::optional<VectorScale> scale = std::nullopt;
  std::vector<float> scaled = {};  // (B, V)
};

Policy::Policy(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
               int max_batch)
    : impl_(std::make_unique<Impl>(Impl{network, spec, precision, max_batch})) {
  const ThreadScope scope(impl_->threads);
  impl_->built = impl_->Build(ActorOutput::kGaussian);
}

Policy::~Policy() = default;

void Policy::Load(TensorMap tensors, const std::string& source) {
  auto owner = std::make_shared<const TensorMap>(std::move(tensors));
  const TensorViews views(*owner);
  impl_->Load(views, std::move(owner), source);
}

void Policy::Load(const SharedBytes& file, const std::string& source) {
  impl_->Load(ReadSafetensorsViews(file.view(), source), std::make_shared<SharedBytes>(file),
              source);
}

void Policy::Impl::Load(const TensorViews& tensors, std::shared_ptr<const void> owner,
                        const std::string& source) {
  const ThreadScope scope(threads);
  const ActorOutput output = ActorOutputOf(tensors, spec.action_size);
  std::unique_ptr<Built> other;
  if (output != built->actor.output) other = Build(output);
  Built& target = other ? *other : *built;
  // Reading may throw. It comes first, so that an error leaves the old weights in place.
  std::optional<VectorScale> read = ReadVectorScale(tensors, spec.VectorSize(), source);
  target.parameters.Borrow(tensors, source);
  target.loaded = std::move(owner);
  for (auto& [batch, sized] : target.networks) sized.Refresh();
  if (other) built = std::move(other);
  scale = std::move(read);
}

PolicyOutput Policy::Forward(int batch, const uint8_t* frames, const float* vector) {
  CHECK(batch > 0 && batch <= impl_->max_batch) << batch << " of at most " << impl_->max_batch;
  const ThreadScope scope(impl_->threads);
  SizedNetwork& network = impl_->built->ForBatch(batch);
  if (network.encoder) network.encoder->Forward(frames, Statistics::kRunning);
  if (impl_->scale) {
    impl_->scaled.resize(static_cast<size_t>(batch) *
                         static_cast<size_t>(impl_->spec.VectorSize()));
    impl_->scale->Apply(vector, impl_->scaled);
    vector = impl_->scaled.data();
  }
  network.actor->Forward(vector);
  const size_t count = static_cast<size_t>(batch) * static_cast<size_t>(impl_->spec.action_size);
  PolicyOutput result{.mean = {network.actor->mean(), count},
                      .log_std = {},
                      .squashed = impl_->built->actor.output != ActorOutput::kUnsquashed};
  if (network.actor->log_std() != nullptr) result.log_std = {network.actor->log_std(), count};
  return result;
}

}  // namespace shoal::nn

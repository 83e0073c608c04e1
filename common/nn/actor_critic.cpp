#include "common/nn/actor_critic.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/actor_head.h"
#include "common/nn/adam.h"
#include "common/nn/critic_heads.h"
#include "common/nn/encoder.h"
#include "common/nn/parameter_set.h"

namespace shoal::nn {
namespace {

constexpr const char* kLogTemperature = "temperature.log";
constexpr const char* kAverage = "average.";

// The encoder first, so that the heads are one contiguous range.
std::vector<ParameterShape> EncoderAndCritic(const NetworkConfig& network,
                                             const ObservationSpec& spec) {
  std::vector<ParameterShape> shapes = EncoderParameters(network, spec);
  for (ParameterShape& shape : CriticParameters(network, spec, "critic")) {
    shapes.push_back(std::move(shape));
  }
  return shapes;
}

double GradientSquares(const ParameterSet& set) {
  return SumOfSquares(set.gradients(), set.size());
}

}  // namespace

struct ActorCritic::Impl {
  Impl(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
       const Options& options);

  void Build(const NetworkConfig& network, const ObservationSpec& spec, Precision precision,
             int batch);
  // Each follows a change of its set's values.
  void RefreshCritic();
  void RefreshAll();
  TensorMap Export() const;
  // Throws Error half-way.
  void Import(const TensorMap& tensors, const std::string& source);

  ParameterSet critic_set, actor_set, target_set, temperature_set;
  // Moving averages; the encoder's has the layout of the first part of critic_set.
  ParameterSet encoder_average, actor_average;
  Adam critic_optimiser, actor_optimiser, temperature_optimiser;
  const int64_t critic_heads;      // where critic.* begins in critic_set; target_set has its layout
  std::optional<Encoder> encoder;  // empty without pixels
  std::optional<CriticHeads> critic, target;
  std::optional<ActorHead> actor;
};

ActorCritic::Impl::Impl(const NetworkConfig& network, const ObservationSpec& spec,
                        Precision precision, const Options& options)
    : critic_set(EncoderAndCritic(network, spec), ParameterSet::Use::kTraining),
      actor_set(ActorParameters(network, spec), ParameterSet::Use::kTraining),
      target_set(CriticParameters(network, spec, "target"), ParameterSet::Use::kInference),
      temperature_set({{kLogTemperature, {1}}}, ParameterSet::Use::kTraining),
      encoder_average(EncoderParameters(network, spec), ParameterSet::Use::kInference),
      actor_average(ActorParameters(network, spec), ParameterSet::Use::kInference),
      critic_optimiser(&critic_set, options.learning_rate),
      actor_optimiser(&actor_set, options.learning_rate),
      temperature_optimiser(&temperature_set, options.learning_rate),
      critic_heads(critic_set.OffsetOf("critic.")) {
  CHECK(critic_set.size() - critic_heads == target_set.size());
  CHECK(encoder_average.size() == critic_heads);
  critic_set.Initialise(options.seed);
  actor_set.Initialise(options.seed);
  std::copy_n(critic_set.values() + critic_heads, target_set.size(), target_set.values());
  temperature_set.values()[0] = float(std::log(options.initial_temperature));
  std::copy_n(critic_set.values(), encoder_average.size(), encoder_average.values());
  std::copy_n(actor_set.values(), actor_average.size(), actor_average.values());
  Build(network, spec, precision, options.batch);
  RefreshAll();
}

void ActorCritic::Impl::Build(const NetworkConfig& network, const ObservationSpec& spec,
                              Precision precision, int batch) {
  const auto scratchpad = std::make_shared<Scratchpad>();
  const auto context = [&](const ParameterSet& set, bool training) {
    return LayerContext{&set, precision, batch, training, scratchpad};
  };
  dnnl::memory features, features_gradient;
  if (spec.HasPixels()) {
    encoder.emplace(context(critic_set, true), network, spec);
    features = encoder->features();
    features_gradient = encoder->features_gradient();
  }
  critic.emplace(context(critic_set, true), "critic", network, spec, features, features_gradient);
  target.emplace(context(target_set, false), "target", network, spec, features, dnnl::memory());
  actor.emplace(context(actor_set, true), network, spec, features);
}

void ActorCritic::Impl::RefreshCritic() {
  if (encoder) encoder->Refresh();
  critic->Refresh();
}

void ActorCritic::Impl::RefreshAll() {
  RefreshCritic();
  actor->Refresh();
  target->Refresh();
}

TensorMap ActorCritic::Impl::Export() const {
  TensorMap tensors;
  for (const ParameterSet* set : {&critic_set, &actor_set, &target_set, &temperature_set}) {
    set->Export(set->values(), "", &tensors);
  }
  for (const ParameterSet* set : {&encoder_average, &actor_average}) {
    set->Export(set->values(), kAverage, &tensors);
  }
  critic_optimiser.Export("critic", &tensors);
  actor_optimiser.Export("actor", &tensors);
  temperature_optimiser.Export("temperature", &tensors);
  return tensors;
}

void ActorCritic::Impl::Import(const TensorMap& tensors, const std::string& source) {
  for (ParameterSet* set : {&critic_set, &actor_set, &target_set, &temperature_set}) {
    set->Import(tensors, "", source, set->values());
  }
  for (ParameterSet* set : {&encoder_average, &actor_average}) {
    set->Import(tensors, kAverage, source, set->values());
  }
  critic_optimiser.Import(tensors, "critic", source);
  actor_optimiser.Import(tensors, "actor", source);
  temperature_optimiser.Import(tensors, "temperature", source);
  RefreshAll();
}

ActorCritic::ActorCritic(const NetworkConfig& network, const ObservationSpec& spec,
                         Precision precision, const Options& options)
    : impl_(std::make_unique<Impl>(network, spec, precision, options)) {}

ActorCritic::~ActorCritic() = default;

void ActorCritic::Encode(const uint8_t* frames) {
  if (impl_->encoder) impl_->encoder->Forward(frames);
}

ActorCritic::Gaussian ActorCritic::ForwardActor(const float* vector) {
  impl_->actor->Forward(vector);
  return {impl_->actor->mean(), impl_->actor->log_std()};
}

ActorCritic::TwinQ ActorCritic::ForwardTarget(const float* vector, const float* action) {
  impl_->target->ForwardObservation(vector);
  impl_->target->ForwardAction(action);
  return {impl_->target->q(0), impl_->target->q(1)};
}

ActorCritic::TwinQ ActorCritic::ForwardCritic(const float* vector, const float* action) {
  impl_->critic->ForwardObservation(vector);
  impl_->critic->ForwardAction(action);
  return {impl_->critic->q(0), impl_->critic->q(1)};
}

double ActorCritic::BackwardCritic(const float* q0_gradient, const float* q1_gradient) {
  impl_->critic->Backward(q0_gradient, q1_gradient);
  if (impl_->encoder) impl_->encoder->Backward();
  return GradientSquares(impl_->critic_set);
}

void ActorCritic::BackwardAction(const float* q0_gradient, const float* q1_gradient,
                                 float* action_gradient) {
  impl_->critic->BackwardAction(q0_gradient, q1_gradient, action_gradient);
}

double ActorCritic::BackwardActor(const float* mean_gradient, const float* log_std_gradient) {
  impl_->actor->Backward(mean_gradient, log_std_gradient);
  return GradientSquares(impl_->actor_set);
}

void ActorCritic::StepCritic() {
  impl_->critic_optimiser.Step();
  impl_->RefreshCritic();
}

void ActorCritic::UndoStepCritic() {
  impl_->critic_optimiser.Undo();
  impl_->RefreshCritic();
}

void ActorCritic::StepActor() {
  impl_->actor_optimiser.Step();
  impl_->actor->Refresh();
}

float ActorCritic::Temperature() const { return std::exp(impl_->temperature_set.values()[0]); }

void ActorCritic::StepTemperature(float gradient) {
  *impl_->temperature_set.Find(kLogTemperature).gradient() = gradient;
  impl_->temperature_optimiser.Step();
}

void ActorCritic::MoveTarget(float tau) {
  MoveTowards(tau, impl_->critic_set.values() + impl_->critic_heads, impl_->target_set.size(),
              impl_->target_set.values());
  impl_->target->Refresh();
}

void ActorCritic::MovePolicyAverage(float rate) {
  const auto move = [rate](const ParameterSet& online, ParameterSet* average) {
    MoveTowards(rate, online.values(), average->size(), average->values());
  };
  move(impl_->critic_set, &impl_->encoder_average);
  move(impl_->actor_set, &impl_->actor_average);
}

TensorMap ActorCritic::AveragedPolicyTensors() const {
  TensorMap policy;
  for (const ParameterSet* set : {&impl_->encoder_average, &impl_->actor_average}) {
    set->Export(set->values(), "", &policy);
  }
  return policy;
}

TensorMap ActorCritic::PolicyTensors() const {
  TensorMap all, policy;
  impl_->critic_set.Export(impl_->critic_set.values(), "", &all);
  for (auto& [name, tensor] : all) {
    if (name.starts_with("encoder.")) policy[name] = std::move(tensor);
  }
  impl_->actor_set.Export(impl_->actor_set.values(), "", &policy);
  return policy;
}

TensorMap ActorCritic::AllTensors() const { return impl_->Export(); }

void ActorCritic::Restore(const TensorMap& tensors, const std::string& source) {
  const TensorMap former = impl_->Export();
  try {
    impl_->Import(tensors, source);
  } catch (const Error&) {
    impl_->Import(former, "former state");
    throw;
  }
}

}  // namespace shoal::nn

#include "learner/agent/sac/sac_networks.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "common/nn/actor_critic_plan.h"
#include "learner/agent/critic_encoder.h"
#include "learner/agent/step_sizes.h"

namespace shoal::learner {
namespace {

using nn::Module;
using nn::ParameterSet;

constexpr const char* kLogTemperature = "temperature.log";

const nn::Features* FeaturesOf(const std::unique_ptr<nn::EncoderModule>& encoder) {
  return encoder ? &encoder->features() : nullptr;
}

}  // namespace

SacNetworks::SacNetworks(const Config& config, const ObservationSpec& spec, nn::Precision precision,
                         int threads)
    : context_(precision, config.learner.batch, threads),
      encoder_(MakeCriticEncoder(config.network, spec, context_)),
      critic_(nn::PlanCritic(config.network, spec, "critic"), FeaturesOf(encoder_),
              /*trains_encoder=*/true, Module::Use::kTraining, context_),
      target_(nn::PlanCritic(config.network, spec, "target"), FeaturesOf(encoder_),
              /*trains_encoder=*/false, Module::Use::kInference, context_),
      actor_(nn::PlanActor(config.network, spec), FeaturesOf(encoder_), /*trains_encoder=*/false,
             Module::Use::kTraining, context_),
      temperature_({{kLogTemperature, {1}}}, ParameterSet::Use::kTraining),
      encoder_average_(nn::PlanEncoder(config.network, spec).Parameters(),
                       ParameterSet::Use::kInference),
      actor_average_(nn::PlanActor(config.network, spec).Parameters(),
                     ParameterSet::Use::kInference),
      critic_optimiser_(CriticSets(encoder_.get(), &critic_), CriticStep(config.learner)),
      actor_optimiser_({&actor_.parameters()}, ActorStep(config.learner)),
      temperature_optimiser_({&temperature_}, {.rate = TemperatureRate(config.learner)}) {
  const auto seed = static_cast<uint64_t>(config.seed);
  if (encoder_) {
    encoder_->parameters().Initialise(seed);
    nn::CopyParameters(encoder_->parameters(), &encoder_average_);
  }
  critic_.parameters().Initialise(seed);
  actor_.parameters().Initialise(seed);
  temperature_.values()[0] = static_cast<float>(std::log(config.learner.initial_temperature));
  RefreshCritic();
  actor_.Refresh();
  nn::CopyParameters(critic_, &target_);
  nn::CopyParameters(actor_.parameters(), &actor_average_);
}

void SacNetworks::Encode(const uint8_t* frames, nn::Statistics statistics) {
  if (encoder_) encoder_->Forward(frames, statistics);
}

SacNetworks::Gaussian SacNetworks::ForwardActor(const float* vector) {
  const nn::ActorModule::Output output = actor_.Forward(vector);
  return {output.mean, output.log_std};
}

SacNetworks::TwinQ SacNetworks::ForwardTarget(const float* vector, const float* action) {
  target_.ForwardObservation(vector);
  target_.ForwardAction(action);
  return {target_.q(0), target_.q(1)};
}

SacNetworks::TwinQ SacNetworks::ForwardCritic(const float* vector, const float* action) {
  critic_.ForwardObservation(vector);
  critic_.ForwardAction(action);
  return {critic_.q(0), critic_.q(1)};
}

double SacNetworks::BackwardCritic(const QGradients& q_gradients) {
  critic_.Backward(q_gradients);
  if (encoder_) encoder_->Backward();
  return critic_optimiser_.GradientSquares();
}

void SacNetworks::BackwardAction(const QGradients& q_gradients, float* action_gradient) {
  critic_.BackwardAction(q_gradients, action_gradient);
}

double SacNetworks::BackwardActor(const float* mean_gradient, const float* log_std_gradient) {
  actor_.Backward(mean_gradient, log_std_gradient);
  return actor_optimiser_.GradientSquares();
}

void SacNetworks::RefreshCritic() {
  if (encoder_) encoder_->Refresh();
  critic_.Refresh();
}

void SacNetworks::StepCritic() {
  critic_optimiser_.Step();
  RefreshCritic();
}

void SacNetworks::UndoStepCritic() {
  critic_optimiser_.Undo();
  RefreshCritic();
}

void SacNetworks::StepActor() {
  actor_optimiser_.Step();
  actor_.Refresh();
}

float SacNetworks::Temperature() const { return std::exp(temperature_.values()[0]); }

void SacNetworks::StepTemperature(float gradient, double least) {
  temperature_.gradients()[0] = gradient;
  temperature_optimiser_.Step();
  float& log_temperature = temperature_.values()[0];
  log_temperature = std::max(log_temperature, float(std::log(least)));  // of 0: no bound
}

void SacNetworks::MoveTarget(float tau) { nn::MoveTowards(tau, critic_, &target_); }

void SacNetworks::MovePolicyAverage(float rate) {
  if (encoder_) nn::MoveTowards(rate, encoder_->parameters(), &encoder_average_);
  nn::MoveTowards(rate, actor_.parameters(), &actor_average_);
}

nn::TensorMap SacNetworks::PolicyTensors() const {
  nn::TensorMap policy;
  if (encoder_) encoder_->parameters().Export(&policy);
  actor_.parameters().Export(&policy);
  return policy;
}

nn::TensorMap SacNetworks::AveragedPolicyTensors() const {
  nn::TensorMap policy;
  encoder_average_.Export(&policy);
  actor_average_.Export(&policy);
  return policy;
}

void SacNetworks::AddTo(AgentState* state) {
  if (encoder_) state->Add(encoder_.get());
  for (nn::Module* module : std::initializer_list<nn::Module*>{&critic_, &target_, &actor_}) {
    state->Add(module);
  }
  state->Add(&temperature_, "");
  state->Add(&encoder_average_, "average");
  state->Add(&actor_average_, "average");
  state->Add(&critic_optimiser_, "critic");
  state->Add(&actor_optimiser_, "actor");
  state->Add(&temperature_optimiser_, "temperature");
}

}  // namespace shoal::learner

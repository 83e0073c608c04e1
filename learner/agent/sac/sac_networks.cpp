// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sac/sac_networks.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "common/base/check.h"
#include "common/nn/actor_critic_plan.h"
#include "learner/agent/critic_vectors.h"
#include "learner/agent/encoder_and_head.h"
#include "learner/agent/step_sizes.h"

namespace shoal::learner {
namespace {

using nn::EncoderModule;
using nn::Module;
using nn::ParameterSet;

constexpr const char* kLogTemperature = "temperature.log";

const nn::Features* FeaturesOf(const EncoderModule* encoder) {
  return encoder != nullptr ? &encoder->features() : nullptr;
}

bool Separate(const Config& config) { return config.network.encoders == "separate"; }

nn::HeadPlan CriticPlan(const Config& config, const ObservationSpec& spec, const char* name) {
  return nn::PlanCritic(config.network, CriticSpec(config.learner, spec), name);
}

}  // namespace

SacNetworks::SacNetworks(const Config& config, const ObservationSpec& spec, nn::Precision precision,
                         nn::Replica* replica)
    : replica_(replica),
      context_(precision, config.learner.batch, replica),
      asymmetric_(bool(config.learner.critic_blocks)),
      encoder_(MakeEncoder(config.network, spec, Module::Use::kTraining, context_)),
      critic_encoder_(Separate(config) ? MakeEncoder(config.network, spec, Module::Use::kTraining,
                                                     context_, "critic.encoder")
                                       : nullptr),
      target_encoder_(config.network.target_encoder
                          ? MakeEncoder(config.network, spec, Module::Use::kInference, context_,
                                        "target.encoder")
                          : nullptr),
      critic_(CriticPlan(config, spec, "critic"), FeaturesOf(CriticEncoder()),
              /*trains_encoder=*/true, Module::Use::kTraining, context_),
      target_(CriticPlan(config, spec, "target"),
              FeaturesOf(target_encoder_ ? target_encoder_.get() : CriticEncoder()),
              /*trains_encoder=*/false, Module::Use::kInference, context_),
      actor_(nn::PlanActor(config.network, spec), FeaturesOf(encoder_.get()),
             /*trains_encoder=*/ActorTrains(), Module::Use::kTraining, context_),
      aux_(AuxLoss::Make(config, spec,
                         ActorTrains() ? actor_.trunk_features() : critic_.trunk_features(),
                         context_)),
      temperature_({{kLogTemperature, {1}}}, ParameterSet::Use::kTraining),
      average_(SetsOf(encoder_.get(), &actor_), replica),
      critic_optimiser_(CriticSets(), CriticStep(config.learner), replica),
      actor_optimiser_(ActorSets(), ActorStep(config.learner), replica),
      temperature_optimiser_({&temperature_}, {.rate = TemperatureRate(config.learner)}) {
  const auto seed = static_cast<uint64_t>(config.seed);
  for (EncoderModule* encoder : {encoder_.get(), critic_encoder_.get()}) {
    if (encoder == nullptr) continue;
    encoder->parameters().Initialise(seed);
    encoder->Refresh();
  }
  if (target_encoder_) nn::CopyParameters(*CriticEncoder(), target_encoder_.get());
  critic_.parameters().Initialise(seed);
  actor_.parameters().Initialise(seed);
  temperature_.values()[0] = static_cast<float>(std::log(config.learner.initial_temperature));
  RefreshCritic();
  actor_.Refresh();
  nn::CopyParameters(critic_, &target_);
  average_.Copy();
}

EncoderModule* SacNetworks::CriticEncoder() {
  if (asymmetric_) return nullptr;
  return critic_encoder_ ? critic_encoder_.get() : encoder_.get();
}

std::vector<ParameterSet*> SacNetworks::CriticSets() {
  std::vector<ParameterSet*> sets = SetsOf(CriticEncoder(), &critic_);
  if (Aux(Head::kCritic)) sets.push_back(&aux_->readout().parameters());
  return sets;
}

std::vector<ParameterSet*> SacNetworks::ActorSets() {
  std::vector<ParameterSet*> sets = SetsOf(ActorTrains() ? encoder_.get() : nullptr, &actor_);
  if (Aux(Head::kActor)) sets.push_back(&aux_->readout().parameters());
  return sets;
}

void SacNetworks::EncodeNext(const uint8_t* frames) {
  if (!encoder_) return;
  encoder_->Forward(frames, nn::Statistics::kRunning);
  EncoderModule* of_target = target_encoder_ ? target_encoder_.get() : critic_encoder_.get();
  if (of_target != nullptr) of_target->Forward(frames, nn::Statistics::kRunning);
}

void SacNetworks::Encode(const uint8_t* frames) {
  if (CriticEncoder() != nullptr) CriticEncoder()->Forward(frames, nn::Statistics::kBatch);
}

void SacNetworks::EncodeForActor(const uint8_t* frames) {
  if (!ActorTrains()) return;
  encoder_->Forward(frames, nn::Statistics::kBatch);
  if (critic_encoder_) critic_encoder_->Forward(frames, nn::Statistics::kRunning);
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

double SacNetworks::ForwardBackwardAux(const BatchView& drawn) {
  CHECK(aux_);
  return aux_->ForwardBackward(drawn);
}

double SacNetworks::BackwardCritic(const QGradients& q_gradients) {
  critic_.Backward(q_gradients);
  if (CriticEncoder() != nullptr) CriticEncoder()->Backward();
  return critic_optimiser_.GatherGradients();
}

void SacNetworks::BackwardAction(const QGradients& q_gradients, float* action_gradient) {
  critic_.BackwardAction(q_gradients, action_gradient);
}

double SacNetworks::BackwardActor(const float* mean_gradient, const float* log_std_gradient) {
  actor_.Backward(mean_gradient, log_std_gradient);
  if (ActorTrains()) encoder_->Backward();
  return actor_optimiser_.GatherGradients();
}

void SacNetworks::RefreshCritic() {
  if (CriticEncoder() != nullptr) CriticEncoder()->Refresh();
  critic_.Refresh();
  if (Aux(Head::kCritic)) aux_->readout().Refresh();
}

void SacNetworks::SetRateFactor(double factor) {
  for (nn::Adam* optimiser : {&critic_optimiser_, &actor_optimiser_, &temperature_optimiser_}) {
    optimiser->set_rate_factor(factor);
  }
}

void SacNetworks::StepCritic() {
  critic_optimiser_.Step();
  RefreshCritic();
  replica_->Meet();
}

void SacNetworks::UndoStepCritic() {
  critic_optimiser_.Undo();
  RefreshCritic();
}

void SacNetworks::StepActor() {
  actor_optimiser_.Step();
  if (ActorTrains()) encoder_->Refresh();
  actor_.Refresh();
  if (Aux(Head::kActor)) aux_->readout().Refresh();
}

float SacNetworks::Temperature() const { return std::exp(temperature_.values()[0]); }

void SacNetworks::StepTemperature(float gradient, double least) {
  temperature_.gradients()[0] = gradient;
  temperature_optimiser_.Step();
  float& log_temperature = temperature_.values()[0];
  log_temperature = std::max(log_temperature, float(std::log(least)));  // of 0: no bound
}

void SacNetworks::MoveTarget(float tau) {
  std::vector<nn::Following> targets{{&critic_, &target_}};
  if (target_encoder_) targets.push_back({CriticEncoder(), target_encoder_.get()});
  nn::MoveTowards(tau, targets, replica_);
}

nn::TensorMap SacNetworks::PolicyTensors() const {
  nn::TensorMap policy;
  if (encoder_) encoder_->parameters().Export(&policy);
  actor_.parameters().Export(&policy);
  return policy;
}

void SacNetworks::AddTo(AgentState* state) {
  for (EncoderModule* encoder : {encoder_.get(), critic_encoder_.get(), target_encoder_.get()}) {
    if (encoder != nullptr) state->Add(encoder);
  }
  for (nn::Module* module : std::initializer_list<nn::Module*>{&critic_, &target_, &actor_}) {
    state->Add(module);
  }
  if (aux_) state->Add(&aux_->readout());
  state->Add(&temperature_, "");
  average_.AddTo(state);
  state->Add(&critic_optimiser_, "critic");
  state->Add(&actor_optimiser_, "actor");
  state->Add(&temperature_optimiser_, "temperature");
}

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sac/sac_networks.h"

#include <cmath>
#include <initializer_list>

#include "common/base/check.h"
#include "common/nn/actor_critic_plan.h"
#include "learner/agent/critic_outputs.h"
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
  return nn::PlanCritic(config.network, CriticSpec(config, spec), name, config.sac.critics,
                        CriticOutputs(config));
}

std::vector<ParameterSet*> ParametersOf(const std::vector<Module*>& modules) {
  std::vector<ParameterSet*> sets;
  sets.reserve(modules.size());
  for (Module* module : modules) sets.push_back(&module->parameters());
  return sets;
}

}  // namespace

SacNetworks::SacNetworks(const Config& config, const ObservationSpec& spec, Engine* engine)
    : engine_(engine),
      asymmetric_(static_cast<bool>(config.sac.critic_blocks)),
      encoder_(MakeEncoder(config.network, spec, Module::Use::kTraining, engine->modules())),
      critic_encoder_(Separate(config) ? MakeEncoder(config.network, spec, Module::Use::kTraining,
                                                     engine->modules(), "critic.encoder")
                                       : nullptr),
      target_encoder_(config.network.target_encoder
                          ? MakeEncoder(config.network, spec, Module::Use::kInference,
                                        engine->modules(), "target.encoder")
                          : nullptr),
      critic_(CriticPlan(config, spec, "critic"), FeaturesOf(CriticEncoder()),
              /*trains_encoder=*/true, Module::Use::kTraining, engine->modules()),
      target_(CriticPlan(config, spec, "target"),
              FeaturesOf(target_encoder_ ? target_encoder_.get() : CriticEncoder()),
              /*trains_encoder=*/false, Module::Use::kInference, engine->modules()),
      actor_(nn::PlanActor(config.network, spec), FeaturesOf(encoder_.get()),
             /*trains_encoder=*/ActorTrains(), Module::Use::kTraining, engine->modules()),
      aux_(AuxLoss::Make(config, spec,
                         ActorTrains() ? actor_.trunk_features() : critic_.trunk_features(),
                         engine)),
      temperature_({{kLogTemperature, {1}}}, ParameterSet::Use::kTraining),
      average_(SetsOf(encoder_.get(), &actor_), engine),
      critic_optimiser_(ParametersOf(CriticModules()), CriticStep(config.learner),
                        engine->modules()),
      actor_optimiser_(ParametersOf(ActorModules()), ActorStep(config.learner), engine->modules()),
      temperature_optimiser_({&temperature_}, {.rate = TemperatureRate(config)}) {
  const auto seed = static_cast<uint64_t>(config.seed);
  for (EncoderModule* encoder : {encoder_.get(), critic_encoder_.get()}) {
    if (encoder == nullptr) continue;
    encoder->parameters().Initialise(seed);
    encoder->Refresh();
  }
  if (target_encoder_) nn::CopyParameters(*CriticEncoder(), target_encoder_.get());
  critic_.parameters().Initialise(seed);
  actor_.parameters().Initialise(seed);
  temperature_.values()[0] = static_cast<float>(std::log(config.sac.initial_temperature));
  for (Module* module : CriticModules()) module->Refresh();
  for (Module* module : ActorModules()) module->Refresh();
  nn::CopyParameters(critic_, &target_);
  average_.Copy();
}

EncoderModule* SacNetworks::CriticEncoder() {
  if (asymmetric_) return nullptr;
  return critic_encoder_ ? critic_encoder_.get() : encoder_.get();
}

std::vector<Module*> SacNetworks::CriticModules() {
  std::vector<Module*> modules{&critic_};
  if (CriticEncoder() != nullptr) modules.insert(modules.begin(), CriticEncoder());
  if (Aux(Head::kCritic)) modules.push_back(&aux_->readout());
  return modules;
}

std::vector<Module*> SacNetworks::ActorModules() {
  std::vector<Module*> modules{&actor_};
  if (ActorTrains()) modules.insert(modules.begin(), encoder_.get());
  if (Aux(Head::kActor)) modules.push_back(&aux_->readout());
  return modules;
}

void SacNetworks::EncodeNext(Frames frames) {
  if (!encoder_) return;
  encoder_->Forward(frames, nn::Statistics::kRunning);
  EncoderModule* of_target = target_encoder_ ? target_encoder_.get() : critic_encoder_.get();
  if (of_target != nullptr) of_target->Forward(frames, nn::Statistics::kRunning);
}

void SacNetworks::Encode(Frames frames) {
  if (CriticEncoder() != nullptr) CriticEncoder()->Forward(frames, nn::Statistics::kBatch);
}

void SacNetworks::EncodeForActor(Frames frames) {
  // An encoder that the critic trains keeps its features of step 2.
  if (!ActorTrains()) return;
  encoder_->Forward(frames, nn::Statistics::kBatch);
  if (critic_encoder_) critic_encoder_->Forward(frames, nn::Statistics::kRunning);
}

SacNetworks::Gaussian SacNetworks::ForwardActor(Array vector) {
  const nn::ActorModule::Output output = actor_.Forward(vector);
  return {output.mean, output.log_std};
}

SacNetworks::Values SacNetworks::ForwardTarget(Array vector, Array action) {
  target_.ForwardObservation(vector);
  target_.ForwardAction(action);
  return target_.values();
}

SacNetworks::Values SacNetworks::ForwardCritic(Array vector, Array action) {
  critic_.ForwardObservation(vector);
  critic_.ForwardAction(action);
  return critic_.values();
}

Number SacNetworks::ForwardBackwardAux(const Transitions& drawn) {
  CHECK(aux_);
  aux_->ForwardBackward(drawn);
  return aux_->mean_square();
}

void SacNetworks::BackwardCritic(std::span<const Array> q_gradients, Number squares) {
  critic_.Backward(q_gradients);
  if (CriticEncoder() != nullptr) CriticEncoder()->Backward();
  engine_->Gather(&critic_optimiser_, squares);
}

void SacNetworks::BackwardAction(std::span<const Array> q_gradients, Array action_gradient) {
  critic_.BackwardAction(q_gradients, action_gradient);
}

void SacNetworks::BackwardActor(Array mean_gradient, Array log_std_gradient, Number squares) {
  actor_.Backward(mean_gradient, log_std_gradient);
  if (ActorTrains()) encoder_->Backward();
  engine_->Gather(&actor_optimiser_, squares);
}

void SacNetworks::SetRateFactor(Number factor) {
  for (nn::Adam* optimiser : {&critic_optimiser_, &actor_optimiser_, &temperature_optimiser_}) {
    engine_->SetRateFactor(factor, optimiser);
  }
}

// The actor's loss uses the critic after this step.
void SacNetworks::StepCritic() {
  engine_->Step(&critic_optimiser_, CriticModules(), NextUse::kThisUpdate);
}

void SacNetworks::StepActor() {
  engine_->Step(&actor_optimiser_, ActorModules(), NextUse::kNextUpdate);
}

void SacNetworks::ReadTemperature(Number temperature) {
  engine_->Temperature(temperature_, temperature);
}

void SacNetworks::StepTemperature(Number loss, double least) {
  engine_->StepTemperature(loss, least, &temperature_, &temperature_optimiser_);
}

void SacNetworks::MoveTarget(float tau) {
  std::vector<nn::Following> targets{{&critic_, &target_}};
  if (target_encoder_) targets.push_back({CriticEncoder(), target_encoder_.get()});
  engine_->MoveTowards(tau, targets);
}

nn::PendingTensors SacNetworks::CopyPolicy() const {
  nn::PendingTensors policy;
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

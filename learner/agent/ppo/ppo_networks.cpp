// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/ppo_networks.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "learner/agent/encoder_and_head.h"

namespace shoal::learner {
namespace {

using Use = nn::Module::Use;

// Gains of the last layers. The policy's is small, so that initial actions are close to 0.
constexpr double kPolicyGain = 0.01, kValueGain = 1;

bool Shared(const Config& config) { return config.ppo.networks == "shared"; }

nn::HeadPlan PlanActorHead(const Config& config, const ObservationSpec& spec) {
  const int outputs = spec.action_size + (Shared(config) ? 1 : 0);
  return nn::PlanObservationHead(config.network, spec, "actor", outputs,
                                 Shared(config) ? kValueGain : kPolicyGain);
}

// Keeps the first `rows` rows of a tensor.
void KeepRows(int64_t rows, nn::NamedTensor* tensor) {
  const auto former = size_t(tensor->shape[0]);
  tensor->data.resize(tensor->data.size() / former * size_t(rows));
  tensor->shape[0] = rows;
}

}  // namespace

PpoNetworks::Network::Network(const Config& config, const ObservationSpec& spec,
                              const nn::ModuleContext& context, const std::string& encoder_name,
                              const nn::HeadPlan& plan)
    : encoder(MakeEncoder(config.network, spec, Use::kTraining, context, encoder_name)),
      head(plan, encoder ? &encoder->features() : nullptr, /*trains_encoder=*/true, Use::kTraining,
           context) {
  const auto seed = uint64_t(config.seed);
  if (encoder) encoder->parameters().Initialise(seed);
  head.parameters().Initialise(seed);
}

void PpoNetworks::Network::Forward(Frames frames, Array vector, nn::Statistics statistics) {
  if (encoder) encoder->Forward(frames, statistics);
  head.ForwardObservation(vector);
  head.ForwardAction({});  // the head has no action input
}

void PpoNetworks::Network::Backward(Array gradient) {
  head.Backward(std::array{gradient});
  if (encoder) encoder->Backward();
}

PpoNetworks::PpoNetworks(const Config& config, const ObservationSpec& spec, Engine* engine)
    : engine_(engine),
      action_size_(spec.action_size),
      actor_(config, spec, engine->modules(), "encoder", PlanActorHead(config, spec)),
      own_value_(Shared(config)
                     ? nullptr
                     : std::make_unique<Network>(
                           config, spec, engine->modules(), "value.encoder",
                           nn::PlanObservationHead(config.network, spec, "value", 1, kValueGain))),
      log_std_({{"actor.log_std", {spec.action_size}}}, Use::kTraining) {
  std::fill_n(log_std_.Find("actor.log_std").value(), action_size_,
              float(config.ppo.initial_log_std));
  // A shared output layer is initialised as a whole, so the policy's rows get their gain here.
  if (Shared(config) && config.network.initialisation == "orthogonal") {
    const nn::Parameter weight = actor_.head.parameters().Find("actor.mlp.output.weight");
    const int64_t policy_weights = action_size_ * weight.shape()[1];
    std::for_each_n(weight.value(), policy_weights, [](float& w) { w *= float(kPolicyGain); });
  }
  for (nn::Module* module : Modules()) module->Refresh();
  if (own_value_) return;
  shared_mean_ = engine->NewArray(action_size_);
  shared_value_ = engine->NewArray(1);
  shared_gradient_ = engine->NewArray(action_size_ + 1);
}

Array PpoNetworks::mean() const { return own_value_ ? actor_.head.q(0) : shared_mean_; }

Array PpoNetworks::value() const { return own_value_ ? own_value_->head.q(0) : shared_value_; }

void PpoNetworks::Forward(Frames frames, Array vector) {
  actor_.Forward(frames, vector, nn::Statistics::kBatch);
  if (own_value_) {
    own_value_->Forward(frames, vector, nn::Statistics::kBatch);
  } else {
    SplitShared();
  }
}

void PpoNetworks::ForwardValue(Frames frames, Array vector) {
  (own_value_ ? *own_value_ : actor_).Forward(frames, vector, nn::Statistics::kRunning);
  if (!own_value_) SplitShared();
}

void PpoNetworks::Backward(Array mean_gradient, Array value_gradient) {
  if (own_value_) {
    actor_.Backward(mean_gradient);
    own_value_->Backward(value_gradient);
    return;
  }
  const ObservationSpec::Range all[] = {{0, 1}};
  engine_->JoinColumns(mean_gradient, value_gradient, all, shared_gradient_);
  actor_.Backward(shared_gradient_);
}

std::vector<nn::ParameterSet*> PpoNetworks::Sets() {
  std::vector<nn::ParameterSet*> sets;
  for (Network* network : {&actor_, own_value_.get()}) {
    if (network == nullptr) continue;
    std::ranges::copy(SetsOf(network->encoder.get(), &network->head), std::back_inserter(sets));
  }
  sets.push_back(&log_std_);
  return sets;
}

std::vector<nn::Module*> PpoNetworks::Modules() {
  std::vector<nn::Module*> modules;
  for (Network* network : {&actor_, own_value_.get()}) {
    if (network == nullptr) continue;
    if (network->encoder) modules.push_back(network->encoder.get());
    modules.push_back(&network->head);
  }
  return modules;
}

void PpoNetworks::AddTo(AgentState* state) {
  for (Network* network : {&actor_, own_value_.get()}) {
    if (network == nullptr) continue;
    if (network->encoder) state->Add(network->encoder.get());
    state->Add(&network->head);
  }
  state->Add(&log_std_, "");
}

nn::TensorMap PpoNetworks::PolicyTensors() const {
  nn::TensorMap policy;
  if (actor_.encoder) actor_.encoder->parameters().Export(&policy);
  actor_.head.parameters().Export(&policy);
  log_std_.Export(&policy);
  // The last row of a shared output layer belongs to the value.
  if (!own_value_) {
    KeepRows(action_size_, &policy.at("actor.mlp.output.weight"));
    KeepRows(action_size_, &policy.at("actor.mlp.output.bias"));
  }
  return policy;
}

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/ppo_networks.h"

#include <algorithm>
#include <iterator>

#include "common/nn/host_memory.h"
#include "learner/agent/encoder_and_head.h"

namespace shoal::learner {
namespace {

using Use = nn::Module::Use;

// Gains of the last layers: actions start close to their mean 0, values at their scale.
constexpr double kPolicyGain = 0.01, kValueGain = 1;

bool Shared(const Config& config) { return config.ppo.networks == "shared"; }

nn::HeadPlan PlanActorHead(const Config& config, const ObservationSpec& spec) {
  const int outputs = spec.action_size + (Shared(config) ? 1 : 0);
  return nn::PlanObservationHead(config.network, spec, "actor", outputs,
                                 Shared(config) ? kValueGain : kPolicyGain);
}

// The first `rows` rows of a tensor.
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

void PpoNetworks::Network::Forward(nn::Frames frames, nn::Array vector, nn::Statistics statistics) {
  if (encoder) encoder->Forward(frames, statistics);
  head.ForwardObservation(vector);
  head.ForwardAction({});  // it reads none
}

void PpoNetworks::Network::Backward(const std::vector<float>& gradient) {
  const nn::Array gradients[] = {nn::HostArray(gradient)};
  head.Backward(gradients);
  if (encoder) encoder->Backward();
}

PpoNetworks::PpoNetworks(const Config& config, const ObservationSpec& spec,
                         const nn::ModuleContext& context)
    : batch_(context.batch),
      action_size_(spec.action_size),
      actor_(config, spec, context, "encoder", PlanActorHead(config, spec)),
      own_value_(Shared(config)
                     ? nullptr
                     : std::make_unique<Network>(
                           config, spec, context, "value.encoder",
                           nn::PlanObservationHead(config.network, spec, "value", 1, kValueGain))),
      log_std_({{"actor.log_std", {spec.action_size}}}, Use::kTraining),
      mean_(size_t(batch_) * size_t(action_size_)),
      value_(size_t(batch_)),
      mean_gradient_(mean_.size()),
      value_gradient_(value_.size()) {
  std::fill_n(log_std_.Find("actor.log_std").value(), action_size_,
              float(config.ppo.initial_log_std));
  if (Shared(config) && config.network.initialisation == "orthogonal") {
    const nn::Parameter weight = actor_.head.parameters().Find("actor.mlp.output.weight");
    const int64_t policy_weights = action_size_ * weight.shape()[1];
    std::for_each_n(weight.value(), policy_weights, [](float& w) { w *= float(kPolicyGain); });
  }
  Refresh();
}

std::span<const float> PpoNetworks::log_std() {
  return {log_std_.Find("actor.log_std").value(), size_t(action_size_)};
}

std::span<float> PpoNetworks::log_std_gradient() {
  return {log_std_.Find("actor.log_std").gradient(), size_t(action_size_)};
}

void PpoNetworks::TakeValues(const Network& network, int outputs) {
  const float* output = nn::HostValues(network.head.q(0)).data();
  for (int b = 0; b < batch_; ++b) value_[size_t(b)] = output[int64_t{b} * outputs + outputs - 1];
}

void PpoNetworks::Forward(nn::Frames frames, nn::Array vector) {
  actor_.Forward(frames, vector, nn::Statistics::kBatch);
  const int outputs = action_size_ + (own_value_ ? 0 : 1);
  const float* output = nn::HostValues(actor_.head.q(0)).data();
  for (int b = 0; b < batch_; ++b) {
    std::copy_n(output + int64_t{b} * outputs, action_size_,
                mean_.data() + int64_t{b} * action_size_);
  }
  if (own_value_) {
    own_value_->Forward(frames, vector, nn::Statistics::kBatch);
    TakeValues(*own_value_, 1);
  } else {
    TakeValues(actor_, outputs);
  }
}

void PpoNetworks::ForwardValue(nn::Frames frames, nn::Array vector) {
  Network& network = own_value_ ? *own_value_ : actor_;
  network.Forward(frames, vector, nn::Statistics::kRunning);
  TakeValues(network, own_value_ ? 1 : action_size_ + 1);
}

void PpoNetworks::Backward() {
  if (own_value_) {
    actor_.Backward(mean_gradient_);
    own_value_->Backward(value_gradient_);
    return;
  }
  std::vector<float> both;
  both.reserve(mean_gradient_.size() + value_gradient_.size());
  for (int b = 0; b < batch_; ++b) {
    const float* mean = mean_gradient_.data() + int64_t{b} * action_size_;
    both.insert(both.end(), mean, mean + action_size_);
    both.push_back(value_gradient_[size_t(b)]);
  }
  actor_.Backward(both);
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

void PpoNetworks::Refresh() {
  for (Network* network : {&actor_, own_value_.get()}) {
    if (network == nullptr) continue;
    if (network->encoder) network->encoder->Refresh();
    network->head.Refresh();
  }
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
  if (!own_value_) {
    KeepRows(action_size_, &policy.at("actor.mlp.output.weight"));
    KeepRows(action_size_, &policy.at("actor.mlp.output.bias"));
  }
  return policy;
}

}  // namespace shoal::learner

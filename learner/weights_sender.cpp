// SPDX-License-Identifier: Apache-2.0
#include "learner/weights_sender.h"

#include <utility>

#include "common/config/lockstep.h"
#include "common/config/on_policy.h"
#include "common/nn/safetensors.h"

namespace shoal::learner {

WeightsSender::WeightsSender(const RunConfig& run, nn::Precision precision, uint64_t session,
                             const Agent& agent, LearnerSink& sink)
    : config_(run.config),
      spec_hash_(run.spec.Hash()),
      session_(session),
      rounds_(precision == nn::Precision::kBf16 && !LearnsOnPolicy(run.config)),
      agent_(agent),
      sink_(sink),
      awaited_(config_.lockstep || LearnsOnPolicy(config_)),
      period_(static_cast<uint64_t>(config_.learner.weights_period)) {}

bool WeightsSender::DueAfterUpdate() {
  due_ = due_ || Due(agent_.updates());
  return due_ && (awaited_ || Now() - last_sent_ >= kPatience || sink_.WeightsArrived());
}

void WeightsSender::Send(uint64_t env_steps) {
  const std::string bytes = Serialised();
  WeightsMessage message;
  message.spec_hash = spec_hash_;
  message.version = {session_, agent_.updates()};
  message.env_steps = env_steps;
  message.payload = {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
  due_ = !sink_.Publish(message);
  ++(due_ ? unsent_ : sent_);
  last_sent_ = Now();
}

std::string WeightsSender::Serialised() const {
  nn::TensorMap tensors = agent_.PolicyTensors();
  if (rounds_) tensors = nn::ToBf16(std::move(tensors));
  return nn::WriteSafetensors(tensors, {});
}

bool WeightsSender::Due(uint64_t updates) {
  if (LearnsOnPolicy(config_)) return true;
  if (!config_.lockstep) {
    return updates == 1 || updates % period_ == 0;
  }
  while (LockstepUpdatesAtPhaseEnd(config_, phase_) < updates) ++phase_;
  return LockstepUpdatesAtPhaseEnd(config_, phase_) == updates;
}

}  // namespace shoal::learner

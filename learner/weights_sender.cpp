// SPDX-License-Identifier: Apache-2.0
#include "learner/weights_sender.h"

#include <utility>

#include "common/base/check.h"
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
  return due_ && !copied_ &&
         (awaited_ || Now() - last_sent_ >= kPatience || sink_.WeightsArrived());
}

void WeightsSender::Begin(uint64_t env_steps) {
  CHECK(!copied_) << "the weights of update " << copied_->updates << " are on their way";
  copied_ = Copied{agent_.updates(), env_steps, agent_.CopyPolicyTensors()};
  due_ = false;
}

void WeightsSender::SendCopied(uint64_t finite_updates) {
  if (!copied_ || copied_->updates > finite_updates) return;
  Copied copied = *std::exchange(copied_, std::nullopt);
  const std::string bytes = Serialised(copied.tensors.Take());
  WeightsMessage message;
  message.spec_hash = spec_hash_;
  message.version = {session_, copied.updates};
  message.env_steps = copied.env_steps;
  message.payload = {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
  const bool sent = sink_.Publish(message);
  due_ = due_ || !sent;
  ++(sent ? sent_ : unsent_);
  last_sent_ = Now();
}

void WeightsSender::Send(uint64_t env_steps) {
  Begin(env_steps);
  SendCopied(agent_.updates());
}

std::string WeightsSender::Serialised(nn::TensorMap tensors) const {
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

// SPDX-License-Identifier: Apache-2.0
#include "learner/evaluation_points.h"

#include "common/base/log.h"
#include "common/nn/safetensors.h"

namespace shoal::learner {

EvaluationPoints::EvaluationPoints(const RunConfig& run, uint64_t session, uint64_t env_steps,
                                   const Agent& agent, LearnerSink& sink)
    : spec_hash_(run.spec.Hash()),
      session_(session),
      interval_(static_cast<uint64_t>(run.config.eval.interval)),
      agent_(agent),
      sink_(sink),
      next_((env_steps / interval_ + 1) * interval_) {}

bool EvaluationPoints::Reached(uint64_t env_steps) {
  if (env_steps < next_) return false;
  next_ = (env_steps / interval_ + 1) * interval_;
  return true;
}

void EvaluationPoints::SetInterval(uint64_t interval, uint64_t env_steps) {
  if (interval == interval_) return;
  interval_ = interval;
  next_ = (env_steps / interval_ + 1) * interval_;
}

void EvaluationPoints::Send(const std::string& checkpoint, uint64_t env_steps) {
  if (unsent_) {
    ++overtaken_;
    log::Warning("weights of {} could not be sent for evaluation before those of {}",
                 unsent_->message.checkpoint, checkpoint);
  }
  Unsent& point = unsent_.emplace();
  point.bytes = nn::WriteSafetensors(agent_.AveragedPolicyTensors(), {});
  point.message.spec_hash = spec_hash_;
  point.message.version = {session_, agent_.updates()};
  point.message.env_steps = env_steps;
  point.message.checkpoint = checkpoint;
  point.message.payload = {reinterpret_cast<const uint8_t*>(point.bytes.data()),
                           point.bytes.size()};
  last_updates_ = agent_.updates();
  Retry();
}

void EvaluationPoints::Retry() {
  if (unsent_ && sink_.Publish(unsent_->message)) unsent_.reset();
}

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "launch/run/stop_rule.h"

#include "common/config/lockstep.h"
#include "common/config/on_policy.h"

namespace shoal::launch {
namespace {

constexpr double kUsualTarget = 0.98;
// Of an episode: rates times counts are whole numbers but for their last bits.
constexpr double kRounding = 1e-6;

double TargetOf(const Config& config) {
  return config.stop.success <= 1 ? config.stop.success : kUsualTarget;
}

// In lockstep the last phase is played to its end.
uint64_t BudgetOf(const Config& config) {
  // On policy only whole rollouts are counted, in lockstep or not.
  const bool phases = config.lockstep && !LearnsOnPolicy(config);
  return phases ? LockstepEnvSteps(config) : static_cast<uint64_t>(config.env_steps);
}

}  // namespace

StopRule::StopRule(const Config& config)
    : stop_(config.stop), budget_(BudgetOf(config)), target_(TargetOf(config)) {}

void StopRule::OnEvaluation(const EvaluationPoint& point) {
  points_.push_back(point);
  Judge(points_.size());
}

void StopRule::Change(const Config& config) {
  stop_ = config.stop;
  budget_ = BudgetOf(config);
  target_ = TargetOf(config);
  first_success_.reset();
  for (size_t end = 1; end <= points_.size(); ++end) Judge(end);
}

void StopRule::Judge(size_t end) {
  if (!first_success_ && Reached(end)) first_success_ = points_[end - Evaluations()];
}

bool StopRule::Reached(size_t end) const {
  if (end < Evaluations()) return false;
  double successes = 0, episodes = 0;
  for (size_t i = end - Evaluations(); i < end; ++i) {
    const EvaluationPoint& point = points_[i];
    if (!point.success) return false;
    episodes += static_cast<double>(point.episodes);
    successes += *point.success * static_cast<double>(point.episodes);
  }
  return successes >= target_ * episodes - kRounding;
}

bool StopRule::TargetReached() const { return stop_.success <= 1 && Reached(points_.size()); }

bool StopRule::BudgetSpent(uint64_t env_steps) const { return env_steps >= budget_; }

}  // namespace shoal::launch

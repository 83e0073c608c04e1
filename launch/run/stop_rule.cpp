// SPDX-License-Identifier: Apache-2.0
#include "launch/run/stop_rule.h"

#include <span>

#include "common/config/lockstep.h"
#include "common/config/on_policy.h"

namespace shoal::launch {
namespace {

constexpr double kUsualTarget = 0.98;

double TargetOf(const Config& config) {
  return config.stop.success <= 1 ? config.stop.success : kUsualTarget;
}

// A lockstep run completes its last phase.
uint64_t BudgetOf(const Config& config) {
  // On policy, only complete rollouts are counted, with or without lockstep.
  const bool phases = config.lockstep && !LearnsOnPolicy(config);
  return phases ? LockstepEnvSteps(config) : static_cast<uint64_t>(config.env_steps);
}

}  // namespace

StopRule::StopRule(const Config& config)
    : stop_(config.stop), budget_(BudgetOf(config)), target_(TargetOf(config)) {}

void StopRule::OnEvaluation(const EvaluationPoint& point) {
  points_.push_back(point);
  successes_.push_back({point.success, point.episodes});
  if (!first_success_) Judge();
}

void StopRule::Change(const Config& config) {
  stop_ = config.stop;
  budget_ = BudgetOf(config);
  target_ = TargetOf(config);
  Judge();
}

void StopRule::Judge() {
  const auto first = FirstReached(successes_, target_, Evaluations());
  first_success_ = first ? std::optional(points_[*first]) : std::nullopt;
}

bool StopRule::TargetReached() const {
  if (stop_.success > 1 || successes_.size() < Evaluations()) return false;
  return ReachTogether(std::span(successes_).last(Evaluations()), target_);
}

bool StopRule::BudgetSpent(uint64_t env_steps) const { return env_steps >= budget_; }

}  // namespace shoal::launch

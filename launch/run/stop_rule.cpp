#include "launch/run/stop_rule.h"

#include "common/config/lockstep.h"
#include "common/config/on_policy.h"

namespace shoal::launch {
namespace {

constexpr double kUsualTarget = 0.98;

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
  Judge(point);
}

void StopRule::Change(const Config& config) {
  stop_ = config.stop;
  budget_ = BudgetOf(config);
  target_ = TargetOf(config);
  streak_ = 0;
  first_success_.reset();
  for (const EvaluationPoint& point : points_) Judge(point);
}

void StopRule::Judge(const EvaluationPoint& point) {
  if (!point.success || *point.success < target_) {
    streak_ = 0;
    return;
  }
  if (streak_ == 0) streak_start_ = point;
  ++streak_;
  if (streak_ >= stop_.evaluations && !first_success_) first_success_ = streak_start_;
}

bool StopRule::TargetReached() const { return stop_.success <= 1 && streak_ >= stop_.evaluations; }

bool StopRule::BudgetSpent(uint64_t env_steps) const { return env_steps >= budget_; }

}  // namespace shoal::launch

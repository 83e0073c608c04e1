// When a run has reached what it was started for. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/config.h"
#include "launch/record/evaluation_point.h"

namespace shoal::launch {

class StopRule {
 public:
  explicit StopRule(const Config& config);

  // In the order of evaluation.
  void OnEvaluation(const EvaluationPoint& point);
  // Judges by the new env_steps and stop.* from now on, former evaluations too.
  void Change(const Config& config);

  // stop.evaluations in a row reached stop.success. Never for a task without success: its runs end
  // by their budget.
  bool TargetReached() const;
  bool BudgetSpent(uint64_t env_steps) const;

  // What first_success() is measured against: stop.success, or 0.98 where a run never stops at it.
  double target() const { return target_; }
  // The first evaluation of the first streak of stop.evaluations at or above target().
  const std::optional<EvaluationPoint>& first_success() const { return first_success_; }

 private:
  void Judge(const EvaluationPoint& point);

  StopConfig stop_;
  uint64_t budget_;
  double target_;
  std::vector<EvaluationPoint> points_;
  int streak_ = 0;
  EvaluationPoint streak_start_;
  std::optional<EvaluationPoint> first_success_;
};

}  // namespace shoal::launch

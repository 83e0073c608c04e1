// SPDX-License-Identifier: Apache-2.0
// Decides when a run has reached its target or its budget. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/config.h"
#include "launch/record/evaluation_point.h"
#include "launch/record/first_reached.h"

namespace shoal::launch {

class StopRule {
 public:
  explicit StopRule(const Config& config);

  // Call in the order of evaluation.
  void OnEvaluation(const EvaluationPoint& point);
  // Uses the new values of env_steps and stop.* from now on, also for earlier evaluations.
  void Change(const Config& config);

  // Whether the pooled episodes of the newest stop.evaluations evaluations reached stop.success.
  // For the error rate of this test see docs/algorithm.md ("When a run stops"). Always false for a
  // task without success; its runs end by the budget.
  bool TargetReached() const;
  bool BudgetSpent(uint64_t env_steps) const;

  // The target of first_success(): stop.success, or 0.98 if stop.success is not set.
  double target() const { return target_; }
  // First evaluation of the first series of stop.evaluations consecutive evaluations whose pooled
  // episodes reached target() (first_reached.h).
  const std::optional<EvaluationPoint>& first_success() const { return first_success_; }

 private:
  size_t Evaluations() const { return static_cast<size_t>(stop_.evaluations); }
  void Judge();  // computes first_success_ from all points

  StopConfig stop_;
  uint64_t budget_;
  double target_;
  std::vector<EvaluationPoint> points_;
  std::vector<EvaluatedSuccess> successes_;  // success of each element of points_
  std::optional<EvaluationPoint> first_success_;
};

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// When a run has reached what it was started for. Pure.
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

  // In the order of evaluation.
  void OnEvaluation(const EvaluationPoint& point);
  // Judges by the new env_steps and stop.* from now on, former evaluations too.
  void Change(const Config& config);

  // The episodes of the newest stop.evaluations evaluations, pooled, reached stop.success: how
  // often that errs is in docs/algorithm.md ("When a run stops"). Never for a task without success:
  // its runs end by their budget.
  bool TargetReached() const;
  bool BudgetSpent(uint64_t env_steps) const;

  // The target of first_success(): stop.success, or 0.98 if that is not set.
  double target() const { return target_; }
  // The first of the first stop.evaluations in a row whose episodes, pooled, reached target()
  // (first_reached.h).
  const std::optional<EvaluationPoint>& first_success() const { return first_success_; }

 private:
  size_t Evaluations() const { return static_cast<size_t>(stop_.evaluations); }
  void Judge();  // by all points

  StopConfig stop_;
  uint64_t budget_;
  double target_;
  std::vector<EvaluationPoint> points_;
  std::vector<EvaluatedSuccess> successes_;  // of the same
  std::optional<EvaluationPoint> first_success_;
};

}  // namespace shoal::launch

// When a run has reached what it was started for. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/config/config.h"

namespace shoal::launch {

// One evaluation, as the coordinator sees it.
struct EvaluationPoint {
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;        // since the run's start
  std::optional<double> success;  // rate, 0..1; empty where the task has no success of its own
  double mean_return = 0;         // unscaled
  std::string checkpoint{};       // folder name under checkpoints/
  size_t episodes = 0;            // played
};

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

// "success 98.0 %, return -0.970", or the return alone where there is no success.
std::string FormatScore(const EvaluationPoint& point);

}  // namespace shoal::launch

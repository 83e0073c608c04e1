// SPDX-License-Identifier: Apache-2.0
// Detects training that runs but does not learn, from the metrics of the agent's updates, and
// returns warnings with numbers. The caller passes the metrics and the time, and logs the warnings.
//
//   all-equal frames       mean pixel deviation within a frame below kMinSpread grey levels
//   frozen cameras         all compared frames of a camera show the same picture
//   saturated actions      more than kMaxSaturation of the action components beyond |a| = 0.99
//   collapsed temperature  below kMinTemperatureShare of the initial temperature
//   rising critic loss     the mean over kLossUpdates updates has increased kRises times in a row,
//                          to more than kRiseFactor times the smallest such mean
//
// Each kind of warning is repeated at most once in each kRepeat. The coordinator detects a flat
// success rate (launch/run/flat_score.h).
#pragma once

#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/config/config.h"
#include "learner/agent/update_figures.h"

namespace shoal::learner {

class TrainingGuard {
 public:
  explicit TrainingGuard(const Config& config);

  // `mean`: means over the `updates` > 0 updates since the last call. A check is skipped if its
  // metric is absent. Returns the warnings that are due.
  std::vector<std::string> Check(const UpdateFigures& mean, int updates, SteadyTime now);

  uint64_t warnings() const { return warnings_; }

  static constexpr float kMinSpread = 1;
  static constexpr float kFrozen = 0.99f;  // number of frozen cameras, mean over all batches
  static constexpr float kMaxSaturation = 0.95f;
  static constexpr float kMinTemperatureShare = 1e-4f;
  static constexpr int kLossUpdates = 1'000;
  static constexpr int kRises = 5;
  static constexpr double kRiseFactor = 10;
  static constexpr std::chrono::seconds kRepeat{60};

 private:
  enum Kind { kFrames, kCameras, kSaturation, kTemperatureFall, kLossRise, kKinds };

  // Adds the updates to the running mean of the critic loss.
  void FollowLoss(double critic_loss, int updates);

  const double initial_temperature_;
  std::array<std::optional<SteadyTime>, kKinds> said_;
  uint64_t warnings_ = 0;

  double loss_sum_ = 0;  // sum of the losses of loss_updates_ updates, for the next mean
  int loss_updates_ = 0;
  std::optional<double> smallest_loss_, last_loss_;
  int rises_ = 0;  // number of increases in a row, up to last_loss_
};

// Text of the error that ends a run after an update that was not finite.
std::string DescribeNonFinite(const UpdateFigures& figures, uint64_t updates);

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/training_guard.h"

#include <fmt/core.h>

#include <algorithm>

#include "learner/agent/frame_figures.h"
#include "learner/agent/frozen_cameras.h"

namespace shoal::learner {
namespace {

std::string Shown(std::optional<double> value) {
  return value ? fmt::format("{:.4g}", *value) : "unknown";
}

}  // namespace

TrainingGuard::TrainingGuard(const Config& config)
    : initial_temperature_(config.sac.initial_temperature) {}

std::vector<std::string> TrainingGuard::Check(const UpdateFigures& mean, int updates,
                                              SteadyTime now) {
  std::vector<std::string> due;
  const auto warn = [&](Kind kind, std::string line) {
    if (said_[kind] && now - *said_[kind] < kRepeat) return;
    said_[kind] = now;
    ++warnings_;
    due.push_back(std::move(line));
  };
  const auto spread = mean.Get(kFrameSpread);
  if (spread && *spread < kMinSpread) {
    warn(kFrames,
         fmt::format("frames are all of one colour: pixels deviate by {:.3f} grey levels within a "
                     "frame (expected above {}); is a camera looking at anything?",
                     *spread, kMinSpread));
  }
  const auto frozen = mean.Get(kFrozenCameras);
  if (frozen && *frozen >= kFrozen) {
    warn(kCameras,
         fmt::format(
             "{:.1f} camera(s) show one picture in all {} frames compared of each batch; does "
             "the view follow the simulation?",
             *frozen, kComparedStacks));
  }
  const auto saturation = mean.Get(kActionSaturation);
  if (saturation && *saturation > kMaxSaturation) {
    warn(kSaturation, fmt::format("actions are saturated: {:.1f} % of their components lie beyond "
                                  "0.99 (expected below {:.0f} %)",
                                  100 * *saturation, 100 * kMaxSaturation));
  }
  const double least = kMinTemperatureShare * initial_temperature_;
  const auto temperature = mean.Get(kTemperature);
  if (temperature && *temperature < least) {
    warn(kTemperatureFall,
         fmt::format("the temperature has collapsed: {:.3g} (began at {:.3g}, "
                     "expected above {:.3g}); entropy {}",
                     *temperature, initial_temperature_, least, Shown(mean.Get(kEntropy))));
  }
  if (const auto loss = mean.Get(kCriticLoss)) FollowLoss(*loss, updates);
  if (rises_ >= kRises && *last_loss_ > kRiseFactor * *smallest_loss_) {
    warn(kLossRise,
         fmt::format("the critic loss keeps rising: {:.4g} over the last {} updates, {} rises in a "
                     "row, once {:.4g}; Q {}, target {}",
                     *last_loss_, kLossUpdates, rises_, *smallest_loss_, Shown(mean.Get(kQMean)),
                     Shown(mean.Get(kTargetMean))));
  }
  return due;
}

void TrainingGuard::FollowLoss(double critic_loss, int updates) {
  loss_sum_ += critic_loss * updates;
  loss_updates_ += updates;
  if (loss_updates_ < kLossUpdates) return;
  const double loss = loss_sum_ / loss_updates_;
  rises_ = last_loss_ && loss > *last_loss_ ? rises_ + 1 : 0;
  smallest_loss_ = std::min(loss, smallest_loss_.value_or(loss));
  last_loss_ = loss;
  loss_sum_ = 0;
  loss_updates_ = 0;
}

std::string DescribeNonFinite(const UpdateFigures& figures, uint64_t updates) {
  std::string line = fmt::format("update {} is not finite and was not applied: ", updates + 1);
  if (figures.empty()) return line + "its batch holds numbers that are not finite";
  for (const auto& [figure, value] : figures.entries()) {
    if (figure != figures.entries().front().figure) line += ", ";
    line += fmt::format("{} {:.6g}", figure->name, value);
  }
  return line;
}

}  // namespace shoal::learner

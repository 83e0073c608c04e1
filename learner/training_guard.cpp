#include "learner/training_guard.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "learner/agent/frozen_cameras.h"

namespace shoal::learner {

TrainingGuard::TrainingGuard(const Config& config, bool has_pixels)
    : initial_temperature_(config.learner.initial_temperature), has_pixels_(has_pixels) {}

std::vector<std::string> TrainingGuard::Check(const UpdateStats& mean, int updates,
                                              SteadyTime now) {
  FollowLoss(mean, updates);
  std::vector<std::string> due;
  const auto warn = [&](Kind kind, std::string line) {
    if (said_[kind] && now - *said_[kind] < kRepeat) return;
    said_[kind] = now;
    ++warnings_;
    due.push_back(std::move(line));
  };
  if (has_pixels_ && mean.frame_spread < kMinSpread) {
    warn(kFrames,
         fmt::format("frames are all of one colour: pixels deviate by {:.3f} grey levels within a "
                     "frame (expected above {}); is a camera looking at anything?",
                     mean.frame_spread, kMinSpread));
  }
  if (has_pixels_ && mean.frozen_cameras >= kFrozen) {
    warn(kCameras,
         fmt::format(
             "{:.1f} camera(s) show one picture in all {} frames compared of each batch; does "
             "the view follow the simulation?",
             mean.frozen_cameras, kComparedStacks));
  }
  if (mean.action_saturation > kMaxSaturation) {
    warn(kSaturation, fmt::format("actions are saturated: {:.1f} % of their components lie beyond "
                                  "0.99 (expected below {:.0f} %)",
                                  100 * mean.action_saturation, 100 * kMaxSaturation));
  }
  const double least = kMinTemperatureShare * initial_temperature_;
  if (mean.temperature < least) {
    warn(kTemperature, fmt::format("the temperature has collapsed: {:.3g} (began at {:.3g}, "
                                   "expected above {:.3g}); entropy {:.3g}",
                                   mean.temperature, initial_temperature_, least, mean.entropy));
  }
  if (rises_ >= kRises && *last_loss_ > kRiseFactor * *smallest_loss_) {
    warn(kCriticLoss,
         fmt::format("the critic loss keeps rising: {:.4g} over the last {} updates, {} rises in a "
                     "row, once {:.4g}; Q {:.4g}, target {:.4g}",
                     *last_loss_, kLossUpdates, rises_, *smallest_loss_, mean.q_mean,
                     mean.target_mean));
  }
  return due;
}

void TrainingGuard::FollowLoss(const UpdateStats& mean, int updates) {
  loss_sum_ += double{mean.critic_loss} * updates;
  loss_updates_ += updates;
  if (loss_updates_ < kLossUpdates) return;
  const double loss = loss_sum_ / loss_updates_;
  rises_ = last_loss_ && loss > *last_loss_ ? rises_ + 1 : 0;
  smallest_loss_ = std::min(loss, smallest_loss_.value_or(loss));
  last_loss_ = loss;
  loss_sum_ = 0;
  loss_updates_ = 0;
}

std::string DescribeNonFinite(const UpdateStats& stats, uint64_t updates) {
  return fmt::format(
      "update {} is not finite and was not applied: critic loss {}, actor loss {}, temperature {}, "
      "Q {}, target {}, gradient norms {} (critic) and {} (actor)",
      updates + 1, stats.critic_loss, stats.actor_loss, stats.temperature, stats.q_mean,
      stats.target_mean, stats.critic_grad_norm, stats.actor_grad_norm);
}

}  // namespace shoal::learner

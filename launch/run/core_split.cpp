// SPDX-License-Identifier: Apache-2.0
#include "launch/run/core_split.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "common/wire/process_name.h"

namespace shoal::launch {
namespace {

std::string DescribeSplit(const Split& split) {
  return fmt::format("{} learner thread{} and {} actor{}", split.threads,
                     split.threads == 1 ? "" : "s", split.actors, split.actors == 1 ? "" : "s");
}

// The growth of the counts between two calls of Look.
SplitCounts Difference(const SplitCounts& before, const SplitCounts& now) {
  return {.env_steps = now.env_steps - before.env_steps,
          .updates = now.updates - before.updates,
          .actor_seconds = now.actor_seconds - before.actor_seconds,
          .actors_waited = now.actors_waited - before.actors_waited,
          .learner_seconds = now.learner_seconds - before.learner_seconds,
          .learner_waited = now.learner_waited - before.learner_waited,
          .servers_cpu_seconds = now.servers_cpu_seconds - before.servers_cpu_seconds};
}

}  // namespace

SplitCounts CountsOf(const MetricsView& view) {
  return {.env_steps = view.Total("actor", "env_steps"),
          .updates = view.Largest("learner", "updates").value_or(0),
          .actor_seconds = view.Seconds("actor"),
          .actors_waited = view.Total("actor", "seconds_waiting_credit"),
          .learner_seconds = view.Seconds("learner"),
          .learner_waited = view.Total("learner", "seconds_waiting_data"),
          .servers_cpu_seconds =
              view.Total("replay", "cpu_seconds") + view.Total("eval", "cpu_seconds")};
}

std::optional<CoreSplit::Move> CoreSplit::Look(double seconds, const SplitCounts& counts,
                                               double updates_per_env_step) {
  if (done_ || counts.updates <= 0 || updates_per_env_step <= 0) return std::nullopt;
  if (!first_update_) {
    first_update_ = seconds;
    settled_at_ = seconds + kSettling;
  }
  if (seconds < settled_at_) return std::nullopt;
  if (!before_) {
    before_ = counts;
    return std::nullopt;
  }
  const bool last = seconds >= *first_update_ + kLast;
  const SplitCounts counted = Difference(*before_, counts);
  const bool enough = counted.learner_seconds >= kMeasured && counted.updates >= kLeastUpdates &&
                      counted.env_steps > 0;
  if (!enough) {
    done_ = last;
    return std::nullopt;
  }
  const auto move = Decide(counted, updates_per_env_step, !last && trials_.size() < kMostMoves);
  if (!move) {
    done_ = true;
    return std::nullopt;
  }
  now_ = move->to;
  settled_at_ = seconds + kSettling;
  before_.reset();
  return move;
}

std::optional<CoreSplit::Move> CoreSplit::Decide(const SplitCounts& counted,
                                                 double updates_per_env_step, bool may_try) {
  const double busy = std::max(0.0, counted.learner_seconds - counted.learner_waited);
  trials_.push_back({.split = now_,
                     .pace = counted.updates / counted.learner_seconds / updates_per_env_step,
                     .update_seconds = busy / counted.updates});
  const Trial& best = *std::ranges::max_element(trials_, {}, &Trial::pace);
  const double further = FurtherThread();
  const CoreCosts costs{.env_step = std::max(1e-6, (counted.actor_seconds - counted.actors_waited) /
                                                       counted.env_steps),
                        .update = std::max(1e-6, trials_.back().update_seconds) * now_.threads /
                                  (1 + further * (now_.threads - 1)),
                        .updates_per_env_step = updates_per_env_step,
                        .servers = counted.servers_cpu_seconds / counted.env_steps,
                        .further_thread = further};
  const Split next = BestSplit(costs, limits_);
  // The model assumes that neither side waits. Waits that keep the measured pace below the modelled
  // one would occur in the other division, too.
  const double gain = PaceOf(costs, next) / std::max(best.pace, PaceOf(costs, now_));
  if (may_try && gain >= kGain && !Tried(next)) {
    return Move{next, fmt::format("{} cores: {} from now on, {} before; an update took {:.1f} ms, "
                                  "an env step {:.2f} ms: {:.2f} times the env steps expected",
                                  limits_.cores, DescribeSplit(next), DescribeSplit(now_),
                                  1e3 * trials_.back().update_seconds, 1e3 * costs.env_step, gain)};
  }
  done_ = true;
  if (best.split == now_ || best.pace < kLoss * trials_.back().pace) return std::nullopt;
  return Move{best.split, fmt::format("{} cores: back to {}, {:.0f} env steps/s; {:.0f} with {}",
                                      limits_.cores, DescribeSplit(best.split), best.pace,
                                      trials_.back().pace, DescribeSplit(now_))};
}

double CoreSplit::FurtherThread() const {
  const Trial& last = trials_.back();
  for (size_t i = trials_.size() - 1; i-- > 0;) {
    const Trial& other = trials_[i];
    if (other.split.threads == last.split.threads || other.update_seconds <= 0) continue;
    // Solves t N = c (1 + w (N - 1)) for w with both trials.
    const double ratio =
        last.update_seconds * last.split.threads / (other.update_seconds * other.split.threads);
    const double below = (last.split.threads - 1) - ratio * (other.split.threads - 1);
    const double further = below == 0 ? -1 : (ratio - 1) / below;
    if (further >= 0) return std::min(further, 1.0);
    // No w >= 0 fits: the speed-up was more than linear, or there was none.
    const bool gained = (ratio <= 1) == (last.split.threads > other.split.threads);
    return gained ? 0.0 : 1.0;
  }
  return CoreCosts::kFurtherThread;
}

bool CoreSplit::Tried(const Split& split) const {
  return std::ranges::any_of(trials_, [&](const Trial& trial) { return trial.split == split; });
}

}  // namespace shoal::launch

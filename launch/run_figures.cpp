#include "launch/run_figures.h"

namespace shoal::launch {

ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now) {
  ProgressFigures figures;
  figures.env_steps_per_second = view.Sum("actor", "env_steps_per_second", now);
  figures.updates = view.Get("learner", 0, "updates");
  figures.updates_per_second = view.Sum("learner", "updates_per_second", now);
  figures.critic_loss = view.Get("learner", 0, "critic_loss");
  figures.actor_loss = view.Get("learner", 0, "actor_loss");
  figures.temperature = view.Get("learner", 0, "temperature");
  figures.policy_lag = view.Get("learner", 0, "policy_lag_p50");
  figures.rollout_success = view.Mean("actor", "rollout_success", "episodes", now);
  // Seconds blocked per second: a share.
  figures.actors_wait = view.Rate("replay", "limiter_blocked_insert_seconds");
  figures.learner_waits = view.Rate("replay", "limiter_blocked_sample_seconds");
  return figures;
}

}  // namespace shoal::launch

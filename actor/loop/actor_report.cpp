// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/actor_report.h"

#include <fmt/core.h>

namespace shoal::actor {

const MetricsMessage& ActorReport::Make(const char* state) {
  const auto env_steps = static_cast<double>(parts_.rollout.env_steps());
  report_.Begin(state);
  report_.Add("env_steps", env_steps);
  report_.AddRate("env_steps_per_second", env_steps);
  AddSending();
  report_.Add("weights_refused", static_cast<double>(parts_.weights.refused()));
  report_.Add("weights_receiver", parts_.weights.receives() ? 1 : 0);
  report_.Add("weights_update", static_cast<double>(parts_.selector.version().update));
  AddStages();
  AddEpisodes();
  AddFaults();
  report_.AddResources();
  return report_.message();
}

void ActorReport::AddSending() {
  const ChunkWindow& window = parts_.sender.window();
  const auto outstanding = static_cast<double>(window.Outstanding());
  report_.Add("made", static_cast<double>(window.stored()) + outstanding);
  report_.Add("outstanding", outstanding);
  report_.Add("credit", static_cast<double>(window.CreditLeft()));
  const auto oldest = window.OldestUnstoredNs();
  report_.Add("queue_age_seconds", oldest ? 1e-9 * static_cast<double>(WallTimeNs() - *oldest) : 0);
  report_.Add("resends", static_cast<double>(window.resent_records()));
  report_.Add("write_timeouts", static_cast<double>(parts_.sender.write_timeouts()));
}

void ActorReport::AddStages() {
  const StageSeconds stages = parts_.rollout.seconds();
  if (stages.users) {
    report_.AddSeconds("user_code", stages.user_code);
    report_.AddSeconds("conversion", stages.conversion);
  } else {
    report_.AddSeconds("physics", stages.physics);
    report_.AddSeconds("rendering", stages.rendering);
  }
  report_.AddSeconds("inference", stages.inference);
  report_.AddSeconds("publishing", parts_.sender.publish_seconds());
  report_.AddSeconds("waiting_credit", parts_.loop.blocked_seconds());
  report_.AddSeconds("weights", parts_.loop.weights_seconds());
}

void ActorReport::AddFaults() {
  for (const worlds::FaultCause cause : worlds::kFaultCauses) {
    report_.Add(fmt::format("faulty_episodes_{}", worlds::NameOf(cause)),
                static_cast<double>(parts_.rollout.faults().count(cause)));
  }
}

void ActorReport::AddEpisodes() {
  const EpisodeLog& episodes = parts_.rollout.episodes();
  report_.Add("episodes", static_cast<double>(episodes.count()));
  if (episodes.count() == 0) return;
  const EpisodeFigures mean = episodes.Mean();
  if (parts_.task.has_success()) report_.Add("rollout_success", episodes.SuccessRate());
  report_.Add("rollout_return", mean.episode_return);
  report_.Add("rollout_length", mean.length);
  if (parts_.task.goal_size() > 0) report_.Add("rollout_final_distance", mean.final_distance);
  for (const worlds::DrawnMass& drawn : mean.drawn_masses) {
    report_.Add("rollout_mass_" + drawn.body, drawn.mass_kg);
  }
}

}  // namespace shoal::actor

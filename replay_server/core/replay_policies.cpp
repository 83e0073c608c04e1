// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/replay_policies.h"

#include <algorithm>

#include "common/config/priorities.h"
#include "common/config/privileged_blocks.h"
#include "common/config/sequences.h"
#include "replay_server/core/hindsight.h"
#include "replay_server/core/movement_selector.h"
#include "replay_server/core/priority_selector.h"
#include "replay_server/core/uniform_selector.h"

namespace shoal::replay {
namespace {

bool Hindsight(const Config& config) { return config.replay.hindsight != "none"; }

HindsightGoal GoalOf(const std::string& kind) {
  if (kind == "final") return HindsightGoal::kFinal;
  return kind == "episode" ? HindsightGoal::kEpisode : HindsightGoal::kFuture;
}

MovementKind MovementOf(const std::string& kind) {
  return kind == "displacement" ? MovementKind::kDisplacement : MovementKind::kPath;
}

std::unique_ptr<Selector> MakeSelector(const ReplayConfig& config, const Ring& ring,
                                       const EpisodeIndex& index) {
  if (!HasPriorities(config)) return std::make_unique<UniformSelector>(ring, index);
  const auto kind = config.priorities == "lap" ? PriorityKind::kLap : PriorityKind::kProportional;
  return std::make_unique<PrioritySelector>(ring, index,
                                            PriorityScale(kind, config.priority_exponent));
}

}  // namespace

ReplayPolicies MakePolicies(const RunConfig& run, const Ring& ring, const EpisodeIndex& index) {
  CheckHindsight(run);
  const ReplayConfig& config = run.config.replay;
  ReplayPolicies policies;
  policies.selector = MakeSelector(config, ring, index);
  if (!Hindsight(run.config)) return policies;
  policies.relabeller = std::make_unique<HindsightRelabeller>(ring, index, GoalOf(config.hindsight),
                                                              config.hindsight_goals);
  policies.goals = std::make_unique<GoalChange>(run.spec, TaskOf(run),
                                                PrivilegedBlocksOf(run.config, run.spec).all,
                                                run.config.end_on_success);
  if (config.movement_share > 0) {
    policies.selector = std::make_unique<MovementSelector>(
        ring, index, *policies.goals, config.movement_share, MovementOf(config.movement));
  }
  return policies;
}

IndexOptions IndexOptionsOf(const RunConfig& run) {
  return {.stack = run.spec.stack,
          .n_step = SampleStepsOf(run.config),
          .whole_episodes = Hindsight(run.config),
          .goal_pictures = run.spec.goal_picture};
}

uint64_t WaitingSteps(const RunConfig& run) {
  int steps = SampleStepsOf(run.config) - 1;
  if (Hindsight(run.config)) steps = std::max(steps, TaskOf(run).EnvStepsPerEpisode(1));
  return static_cast<uint64_t>(steps) * static_cast<uint64_t>(run.config.envs_per_actor);
}

}  // namespace shoal::replay

// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/hindsight.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/config/sequences.h"
#include "common/tasks/task_registry.h"

namespace shoal::replay {

HindsightRelabeller::HindsightRelabeller(const Ring& ring, const EpisodeIndex& index,
                                         HindsightGoal kind, int goals_per_sample)
    : ring_(ring),
      index_(index),
      kind_(kind),
      share_(static_cast<double>(goals_per_sample) / (goals_per_sample + 1)) {
  CHECK(goals_per_sample >= 0) << goals_per_sample;
}

uint64_t HindsightRelabeller::DrawGoal(uint64_t id, Random* random) {
  if (random->Uniform() >= share_) return 0;
  if (kind_ == HindsightGoal::kFinal) {
    uint64_t last = id;
    while (const uint64_t next = index_.Next(last)) last = next;
    return last;
  }
  uint64_t first = id;
  if (kind_ == HindsightGoal::kEpisode) {
    // Goes back to the oldest stored step. A reset gives no goal, because no action led to it.
    for (uint64_t step = id; step != 0 && ring_.Header(step).kind == RecordKind::kStep;
         step = index_.Previous(step)) {
      first = step;
    }
  }
  steps_.clear();
  for (uint64_t step = first; step != 0; step = index_.Next(step)) steps_.push_back(step);
  return steps_[random->Below(steps_.size())];
}

tasks::Task TaskOf(const RunConfig& run) {
  return tasks::FindTask(run.spec.task, run.config.distance_threshold);
}

namespace {

// Requires a task with goals whose rewards can be computed for another goal.
void CheckTask(const RunConfig& run, const tasks::Task& task) {
  const Config& config = run.config;
  const std::string& kind = config.replay.hindsight;
  if (task.goal_size() == 0) {
    const std::string& why = task.no_goals();
    throw UsageError("replay.hindsight = {}: task {} has no goals{}{}; expected none", kind,
                     task.name(), why.empty() ? "" : " that Shoal knows: ", why);
  }
  if (task.episode_length() >= tasks::kNoTimeLimit) {
    throw UsageError(
        "replay.hindsight = {}: the episodes of {} have no time limit that Shoal knows, so the "
        "replay "
        "cannot say how many of them it holds; expected one (gymnasium.wrappers.TimeLimit)",
        kind, task.name());
  }
  const int repeat = task.ActionRepeat(config.action_repeat);
  if (repeat > 1) {
    throw UsageError(
        "replay.hindsight = {} with action_repeat = {}: a reward summed over control steps cannot "
        "be computed for another goal; expected action_repeat = 1",
        kind, repeat);
  }
  if (!run.spec.Observed(task.desired_goal().name) && !run.spec.goal_picture) {
    throw UsageError(
        "replay.hindsight = {} with observation.goal_mode = {}: the policy would not see the "
        "goal; expected desired, both or image",
        kind, config.observation.goal_mode);
  }
}

// Requires room for the ended episodes that the first batch needs, besides the unfinished ones.
void CheckCapacity(const RunConfig& run, const tasks::Task& task) {
  const Config& config = run.config;
  const std::string& kind = config.replay.hindsight;
  const int64_t steps = task.EnvStepsPerEpisode(task.ActionRepeat(config.action_repeat));
  const int64_t usable = steps - (SampleStepsOf(config) - 1);  // first steps of samples
  if (usable <= 0) {
    throw UsageError("{}: an episode of {} has {} steps; expected at most that",
                     SampleStepsText(config), task.name(), steps);
  }
  // Two episodes of each environment are not usable: the one that just ended and the unfinished
  // one.
  const int64_t envs = int64_t{config.envs_per_actor} * std::max(1, config.actors);
  const int64_t beside = run.spec.goal_picture ? 2 : 1;  // records of an episode besides its steps
  const int64_t ended = (config.replay.min_size + usable - 1) / usable;
  int64_t sample_records = ended * (steps + beside);
  // In the worst case each episode succeeds with its first step.
  if (config.end_on_success) {
    sample_records = std::max(sample_records, config.replay.min_size * (1 + beside));
  }
  const int64_t least = sample_records + 2 * envs * (steps + beside);
  if (config.replay.capacity < least) {
    throw UsageError(
        "replay.hindsight = {}: replay.capacity = {} does not hold replay.min_size = {} "
        "transitions of ended episodes beside those under way; with {} environments and episodes "
        "of {} steps expected at least {}",
        kind, config.replay.capacity, config.replay.min_size, envs, steps, least);
  }
  if (config.lockstep && config.replay.min_size < envs * steps) {
    throw UsageError(
        "replay.hindsight = {} in lockstep: after replay.min_size = {} steps no episode has ended, "
        "so actor and learner would wait for each other; expected at least {}",
        kind, config.replay.min_size, envs * steps);
  }
}

}  // namespace

void CheckHindsight(const RunConfig& run) {
  const ReplayConfig& replay = run.config.replay;
  if (replay.hindsight == "none") {
    if (replay.movement_share == 0) return;
    throw UsageError(
        "replay.movement_share = {} with replay.hindsight = none: the remaining movement is known "
        "for whole episodes only; expected future, final or episode, or a share of 0",
        replay.movement_share);
  }
  const tasks::Task& task = tasks::FindTask(run.spec.task);
  CheckTask(run, task);
  CheckCapacity(run, task);
}

}  // namespace shoal::replay

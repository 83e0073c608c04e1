// SPDX-License-Identifier: Apache-2.0
// An environment that shows every number of its task and no pixels: what the tools look into.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/environment.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

class OpenEnvironment {
 public:
  // `model`: path of another MJCF file; empty = our own. The task outlives the environment.
  OpenEnvironment(const tasks::Task& task, const std::string& model);

  const tasks::Task& task() const { return task_; }

  void Reset(uint64_t stream_key);
  StepResult Step(std::span<const float> action);

  // observation, achieved goal, desired goal, one after another, of the last reset or step.
  std::span<const float> numbers() const { return numbers_; }
  std::span<const float> achieved_goal() const;
  std::span<const float> desired_goal() const;

 private:
  const tasks::Task& task_;
  std::unique_ptr<Environment> environment_;
  std::vector<float> numbers_;
};

// Plays uniform random actions for as many episodes as `env_steps` take; calls `on_reset` after
// every reset and `on_step` after every step. Equal seeds, equal numbers.
void PlayRandomSteps(OpenEnvironment* environment, int env_steps, int64_t seed,
                     const std::function<void()>& on_reset,
                     const std::function<void(const StepResult&)>& on_step);

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Environment for tools: exposes every number of its task and has no pixels.
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
  // `model`: path of another MJCF file; empty = the built-in model. The task outlives the
  // environment.
  OpenEnvironment(const tasks::Task& task, const std::string& model);

  const tasks::Task& task() const { return task_; }

  void Reset(uint64_t stream_key);
  StepResult Step(std::span<const float> action);

  // Observation, achieved goal and desired goal of the last reset or step, concatenated.
  std::span<const float> numbers() const { return numbers_; }
  std::span<const float> achieved_goal() const;
  std::span<const float> desired_goal() const;

 private:
  const tasks::Task& task_;
  std::unique_ptr<Environment> environment_;
  std::vector<float> numbers_;
};

// Plays `env_steps` steps of uniform random actions, in as many episodes as necessary. Calls
// `on_reset` after every reset and `on_step` after every step. Equal seeds give equal numbers.
void PlayRandomSteps(OpenEnvironment* environment, int env_steps, int64_t seed,
                     const std::function<void()>& on_reset,
                     const std::function<void(const StepResult&)>& on_step);

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/open_environment.h"

#include "common/base/random.h"

namespace shoal::worlds {

OpenEnvironment::OpenEnvironment(const tasks::Task& task, const std::string& model) : task_(task) {
  Config config;
  config.task = task.name();
  config.model = model;
  config.observation.pixels = false;
  config.observation.proprioception = true;
  config.observation.goal_mode = task.goal_size() > 0 ? "both" : "none";
  environment_ = MakeEnvironment(config, nullptr);
  numbers_.resize(static_cast<size_t>(environment_->spec().RecordedVectorSize()));
}

void OpenEnvironment::Reset(uint64_t stream_key) {
  environment_->Reset(stream_key, {{}, numbers_});
}

StepResult OpenEnvironment::Step(std::span<const float> action) {
  return environment_->Step(action, {{}, numbers_});
}

std::span<const float> OpenEnvironment::achieved_goal() const {
  return numbers().subspan(static_cast<size_t>(task_.observation().size()),
                           static_cast<size_t>(task_.goal_size()));
}

std::span<const float> OpenEnvironment::desired_goal() const {
  return numbers().last(static_cast<size_t>(task_.goal_size()));
}

void PlayRandomSteps(OpenEnvironment* environment, int env_steps, int64_t seed,
                     const std::function<void()>& on_reset,
                     const std::function<void(const StepResult&)>& on_step) {
  const auto stream = static_cast<uint64_t>(seed);
  Random actions(StreamKey(stream, StreamRole::kEvalPolicy));
  std::vector<float> action(static_cast<size_t>(environment->task().action_size()));
  uint64_t episode = 0;
  bool running = false;
  for (int step = 0; step < env_steps; ++step) {
    if (!running) {
      environment->Reset(StreamKey(stream, StreamRole::kEvalEnvironment, episode++));
      on_reset();
    }
    for (float& component : action) component = static_cast<float>(actions.Uniform(-1, 1));
    const StepResult result = environment->Step(action);
    running = !result.terminated && !result.truncated;
    on_step(result);
  }
}

}  // namespace shoal::worlds

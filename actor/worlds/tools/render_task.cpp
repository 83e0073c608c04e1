// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/render_task.h"

#include <algorithm>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

constexpr int kLongestSide = 4096;

void CheckSide(const char* name, int side) {
  if (side >= 1 && side <= kLongestSide) return;
  throw UsageError("{} is {}; expected 1 to {}", name, side, kLongestSide);
}

}  // namespace

Picture RenderTask(const RenderRequest& request) {
  const tasks::Task& task = tasks::FindTask(request.task);
  const int episode = task.EnvStepsPerEpisode(task.action_repeat());
  CheckSide("width", request.width);
  CheckSide("height", request.height);
  if (request.env_steps < 0 || request.env_steps > episode) {
    throw UsageError("{} env steps before the picture; an episode of {} has {}", request.env_steps,
                     task.name(), episode);
  }
  if (request.goal && request.env_steps > 0) {
    throw UsageError("the picture of a goal is drawn at the reset; expected 0 env steps before it");
  }
  Config config;
  if (request.goal) config.observation.goal_mode = "image";
  config.task = request.task;
  config.model = request.model;
  config.observation.cameras = {
      request.camera.empty()
          ? DefaultCamera(*MakeWorld(task.world(), {.model = request.model})).name
          : request.camera};
  config.observation.width = request.width;
  config.observation.height = request.height;
  config.observation.quality = request.quality;
  const std::shared_ptr<RenderContext> render = MakeRenderContext(config.observation);
  render->SetOutput(request.output);
  const auto environment = MakeEnvironment(config, render);

  const size_t plane = static_cast<size_t>(request.width) * static_cast<size_t>(request.height);
  std::vector<uint8_t> frame(3 * plane);
  std::vector<float> unread(static_cast<size_t>(environment->spec().RecordedVectorSize()));
  const auto seed = static_cast<uint64_t>(request.seed);
  environment->Reset(StreamKey(seed, StreamRole::kEvalEnvironment), {frame, unread});
  Random actions(StreamKey(seed, StreamRole::kEvalPolicy));
  std::vector<float> action(static_cast<size_t>(task.action_size()));
  for (int step = 0; step < request.env_steps; ++step) {
    for (float& component : action) component = static_cast<float>(actions.Uniform(-1, 1));
    const StepResult result = environment->Step(action, {frame, unread});
    if (result.terminated && step + 1 < request.env_steps) {
      throw RuntimeError("the episode of seed {} terminates at env step {}; asked for {}",
                         request.seed, step + 1, request.env_steps);
    }
  }

  if (request.goal) std::ranges::copy(environment->goal_picture(), frame.begin());
  Picture picture{request.width, request.height, std::vector<uint8_t>(3 * plane),
                  config.observation.cameras.front()};
  for (size_t pixel = 0; pixel < plane; ++pixel) {
    for (size_t channel = 0; channel < 3; ++channel) {
      picture.pixels[3 * pixel + channel] = frame[channel * plane + pixel];
    }
  }
  return picture;
}

}  // namespace shoal::worlds

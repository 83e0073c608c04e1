// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/task_description.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <span>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/tools/open_environment.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using tasks::Task;

RangeMeter MeasureRanges(const Task& task, const DescribeRequest& request) {
  OpenEnvironment environment(task, request.model);
  RangeMeter meter(task);
  PlayRandomSteps(
      &environment, request.random_env_steps, request.seed,
      [&] { meter.OnReset(environment.numbers()); },
      [&](const StepResult&) { meter.OnStep(environment.numbers()); });
  return meter;
}

AxisProbe Probe(OpenEnvironment* environment, const Task& task, const DescribeRequest& request,
                int axis, double command) {
  const auto play = [&](double component, int steps) {
    std::vector<float> action(static_cast<size_t>(task.action_size()));
    action[static_cast<size_t>(axis)] = static_cast<float>(component);
    environment->Reset(
        StreamKey(static_cast<uint64_t>(request.seed), StreamRole::kEvalEnvironment));
    int played = 0;
    for (bool running = true; running && played < steps; ++played) {
      const StepResult result = environment->Step(action);
      running = !result.terminated && !result.truncated;
    }
    return played;
  };
  AxisProbe probe{.axis = axis, .command = command, .env_steps = 0, .change = {}};
  // Cuts both rollouts to the length of the shorter one.
  const int still_steps = play(0, request.probe_env_steps);
  probe.env_steps = play(command, still_steps);
  const std::vector<float> moved(environment->numbers().begin(), environment->numbers().end());
  play(0, probe.env_steps);
  for (int i = 0; i < task.observation().size(); ++i) {
    const auto at = static_cast<size_t>(i);
    probe.change.push_back(double{moved[at]} - double{environment->numbers()[at]});
  }
  return probe;
}

double SecondsOfAStep(const Task& task, World* world, int64_t seed) {
  Random random(StreamKey(static_cast<uint64_t>(seed), StreamRole::kEvalEnvironment));
  world->Reset(&random);
  const double before = world->data().time;
  world->Step(std::vector<double>(static_cast<size_t>(task.action_size())));
  return (world->data().time - before) * task.action_repeat();
}

}  // namespace

TaskDescription DescribeTask(const DescribeRequest& request) {
  const Task& task = tasks::FindTask(request.task);
  TaskDescription description;
  description.task = &task;
  const auto world = MakeWorld(task.world(), {.model = request.model});
  description.fingerprint = world->fingerprint();
  description.cameras = CamerasOf(*world);
  description.env_step_seconds = SecondsOfAStep(task, world.get(), request.seed);

  description.random_env_steps = request.random_env_steps;
  const RangeMeter meter = MeasureRanges(task, request);
  description.constant = ConstantNumbers(task, meter);
  description.observations = meter.observations();
  auto next = meter.ranges().begin();
  const auto take = [&next](const tasks::Block& block, std::vector<MeasuredRange>* to) {
    to->assign(next, next + block.size());
    next += block.size();
  };
  take(task.observation(), &description.observation);
  take(task.achieved_goal(), &description.achieved_goal);
  take(task.desired_goal(), &description.desired_goal);

  OpenEnvironment environment(task, request.model);
  for (int axis = 0; axis < task.action_size(); ++axis) {
    for (const double command : {-1.0, 1.0}) {
      description.probes.push_back(Probe(&environment, task, request, axis, command));
    }
  }
  return description;
}

}  // namespace shoal::worlds

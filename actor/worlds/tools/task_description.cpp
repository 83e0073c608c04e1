#include "actor/worlds/tools/task_description.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <span>

#include "actor/worlds/environment.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using tasks::Task;

// An environment that shows every number of its task: observation, achieved goal, desired goal.
class OpenEnvironment {
 public:
  OpenEnvironment(const Task& task, const std::string& model) {
    Config config;
    config.task = task.name();
    config.model = model;
    config.observation.pixels = false;
    config.observation.proprioception = true;
    config.observation.goal_mode = "both";
    environment_ = MakeEnvironment(config, nullptr);
    numbers_.resize(static_cast<size_t>(environment_->spec().VectorSize()));
  }

  void Reset(uint64_t stream_key) { environment_->Reset(stream_key, {{}, numbers_}); }
  // False when the episode has ended.
  bool Step(std::span<const float> action) {
    const StepResult result = environment_->Step(action, {{}, numbers_});
    return !result.terminated && !result.truncated;
  }
  const std::vector<float>& numbers() const { return numbers_; }

 private:
  std::unique_ptr<Environment> environment_;
  std::vector<float> numbers_;
};

std::vector<MeasuredRange> MeasureRanges(const Task& task, const DescribeRequest& request) {
  OpenEnvironment environment(task, request.model);
  std::vector<MeasuredRange> ranges(
      environment.numbers().size(),
      {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()});
  const auto include = [&] {
    for (size_t i = 0; i < ranges.size(); ++i) {
      const double number = environment.numbers()[i];
      ranges[i] = {std::min(ranges[i].low, number), std::max(ranges[i].high, number)};
    }
  };
  const auto seed = static_cast<uint64_t>(request.seed);
  Random actions(StreamKey(seed, StreamRole::kEvalPolicy));
  std::vector<float> action(static_cast<size_t>(task.action_size()));
  uint64_t episode = 0;
  bool running = false;
  for (int step = 0; step < request.random_env_steps; ++step) {
    if (!running) {
      environment.Reset(StreamKey(seed, StreamRole::kEvalEnvironment, episode++));
      include();
    }
    for (float& component : action) component = static_cast<float>(actions.Uniform(-1, 1));
    running = environment.Step(action);
    include();
  }
  return ranges;
}

AxisProbe Probe(OpenEnvironment* environment, const Task& task, const DescribeRequest& request,
                int axis, double command) {
  const auto play = [&](double component, int steps) {
    std::vector<float> action(static_cast<size_t>(task.action_size()));
    action[static_cast<size_t>(axis)] = static_cast<float>(component);
    environment->Reset(
        StreamKey(static_cast<uint64_t>(request.seed), StreamRole::kEvalEnvironment));
    int played = 0;
    for (bool running = true; running && played < steps; ++played)
      running = environment->Step(action);
    return played;
  };
  AxisProbe probe{.axis = axis, .command = command, .env_steps = 0, .change = {}};
  // As many steps as both rollouts last.
  const int still_steps = play(0, request.probe_env_steps);
  probe.env_steps = play(command, still_steps);
  const std::vector<float> moved = environment->numbers();
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
  return world->data().time - before;
}

}  // namespace

TaskDescription DescribeTask(const DescribeRequest& request) {
  const Task& task = tasks::FindTask(request.task);
  TaskDescription description;
  description.task = &task;
  const auto world = MakeWorld(task.world(), request.model);
  description.fingerprint = world->fingerprint();
  description.cameras.assign(world->cameras().begin(), world->cameras().end());
  description.env_step_seconds = SecondsOfAStep(task, world.get(), request.seed);

  description.random_env_steps = request.random_env_steps;
  const std::vector<MeasuredRange> ranges = MeasureRanges(task, request);
  auto next = ranges.begin();
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

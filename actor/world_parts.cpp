// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "actor/program.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/physics_library.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/random.h"

namespace shoal::actor {
namespace {

// Mean times of one environment over some steps of an episode.
struct StepCosts {
  double frame_microseconds = 0;  // drawing a frame, all cameras
  double step_microseconds = 0;   // a whole env step
};

StepCosts MeasureSteps(worlds::Environment& environment) {
  constexpr int kSteps = 10;
  const ObservationSpec& spec = environment.spec();
  std::vector<uint8_t> frame(spec.FrameBytes());
  std::vector<float> vector(static_cast<size_t>(spec.RecordedVectorSize()));
  const std::vector<float> action(static_cast<size_t>(spec.action_size));
  const worlds::ObservationOut out{.frame = frame, .vector = vector};
  environment.Reset(StreamKey(0, StreamRole::kEvalEnvironment, 0),
                    out);  // the first frame also prepares the renderer
  const double before = environment.render_seconds();
  const SteadyTime start = Now();
  int steps = 0;
  try {
    for (bool running = true; running && steps < kSteps; ++steps) {
      const worlds::StepResult result = environment.Step(action, out);
      running = !result.terminated && !result.truncated;
    }
  } catch (const worlds::EpisodeFault&) {  // training counts faults; a measurement ignores them
  }
  const double each = 1e6 / std::max(1, steps);
  return {.frame_microseconds = each * (environment.render_seconds() - before),
          .step_microseconds = each * std::chrono::duration<double>(Now() - start).count()};
}

void AddTasks(const RunConfig& run) {
  if (!run.config.env.id.empty()) {
    throw UsageError(
        "the run's environment is {}, which Python runs: its actors are started by '{} -m "
        "shoal_rl.actor', not by shoal-actor",
        run.config.env.id, run.config.env.python);
  }
  worlds::LoadTasks(run.config.task_library);
}

nlohmann::ordered_json Describe(const Config& config) {
  worlds::LoadTasks(config.task_library);
  std::shared_ptr<worlds::RenderContext> render;
  if (config.observation.pixels) render = worlds::MakeRenderContext(config.observation);
  const auto environment = worlds::MakeEnvironment(config, render);
  nlohmann::ordered_json description = ToJson(environment->spec());
  const StepCosts costs = MeasureSteps(*environment);
  description["frame_microseconds"] = costs.frame_microseconds;
  description["step_microseconds"] = costs.step_microseconds;
  return description;
}

}  // namespace

ActorParts WorldParts() {
  return {.add_tasks = AddTasks, .environments = WorldEnvironments(), .describe = Describe};
}

}  // namespace shoal::actor

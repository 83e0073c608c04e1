// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/world_view.h"

#include <cmath>
#include <string>
#include <vector>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/world_registry.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::actor {
namespace {

CustomCamera CustomOf(const worlds::CameraView& view) {
  return {.lookat = view.lookat,
          .distance = view.distance,
          .azimuth = view.azimuth_degrees,
          .elevation = view.elevation_degrees,
          .body = view.body};
}

Config ViewConfig(const RunConfig& run, const FrameRecorder::Options& options) {
  Config config = run.config;
  ObservationConfig& observation = config.observation;
  std::string camera = options.camera;
  if (camera.empty()) {
    const tasks::Task& task = tasks::FindTask(config.task);
    const auto world = worlds::MakeWorld(task.world(), {config.model, config.physics});
    if (const worlds::CameraView* own = world->film_camera()) {
      camera = own->name;
      observation.custom_cameras[camera] = CustomOf(*own);
    } else {
      camera = observation.pixels ? run.spec.cameras.front() : worlds::DefaultCamera(*world).name;
    }
  }
  observation.pixels = true;
  observation.cameras = {camera};
  observation.grey = false;
  observation.height = options.height;
  observation.width = options.width;
  observation.stack = 1;
  // The view feeds no policy, so it may show the goal's marker although the policy must not see it.
  observation.goal_mode = "none";
  config.replay.hindsight = "none";
  if (!options.quality.empty()) {
    observation.quality = options.quality;
  } else if (observation.quality != "native") {
    observation.quality = "reference";
  }
  return config;
}

std::unique_ptr<worlds::Environment> MakeView(const Config& config) {
  return worlds::MakeEnvironment(config, worlds::MakeRenderContext(config.observation));
}

// Plays one step. Returns the time that an env step takes in the simulated world, 0 = unknown.
uint32_t StepMicroseconds(worlds::Environment& environment, worlds::ObservationOut out) {
  try {
    environment.Reset(0, out);
    const double start = environment.simulated_seconds();
    environment.Step(std::vector<float>(static_cast<size_t>(environment.spec().action_size), 0.0F),
                     out);
    return static_cast<uint32_t>(std::lround(1e6 * (environment.simulated_seconds() - start)));
  } catch (const worlds::EpisodeFault&) {
    return 0;
  }
}

// The view repeats the policy's episode, so a fault of the view alone means that the two differ.
[[noreturn]] void ThrowParted(const worlds::EpisodeFault& fault) {
  throw RuntimeError("the view's environment diverged from the policy's: {}", fault.what());
}

// Converts (3, H, W) to (H, W, 3).
void Interleave(std::span<const uint8_t> planes, std::span<uint8_t> pixels) {
  const size_t plane = planes.size() / 3;
  for (size_t i = 0; i < plane; ++i) {
    for (size_t channel = 0; channel < 3; ++channel) {
      pixels[3 * i + channel] = planes[channel * plane + i];
    }
  }
}

class WorldView final : public EpisodeView {
 public:
  WorldView(const RunConfig& run, const FrameRecorder::Options& options)
      : environment_(MakeView(ViewConfig(run, options))),
        planes_(static_cast<size_t>(environment_->spec().FrameBytes())),
        vector_(static_cast<size_t>(environment_->spec().RecordedVectorSize())),
        step_microseconds_(StepMicroseconds(*environment_, {planes_, vector_})) {}

  int height() const override { return environment_->spec().height; }
  int width() const override { return environment_->spec().width; }
  uint32_t step_microseconds() const override { return step_microseconds_; }

  void Begin(uint64_t stream_key, std::span<uint8_t> picture) override {
    try {
      environment_->Reset(stream_key, {planes_, vector_});
    } catch (const worlds::EpisodeFault& fault) {
      ThrowParted(fault);
    }
    Interleave(planes_, picture);
  }

  void Step(std::span<const float> action, float reward, std::span<uint8_t> picture) override {
    worlds::StepResult result;
    try {
      result = environment_->Step(action, {planes_, vector_});
    } catch (const worlds::EpisodeFault& fault) {
      ThrowParted(fault);
    }
    CHECK(result.reward == reward) << "the view's environment went another way";
    Interleave(planes_, picture);
  }

 private:
  const std::unique_ptr<worlds::Environment> environment_;
  std::vector<uint8_t> planes_;  // (3, H, W)
  std::vector<float> vector_;
  const uint32_t step_microseconds_;
};

}  // namespace

std::unique_ptr<EpisodeView> MakeWorldView(const RunConfig& run,
                                           const FrameRecorder::Options& options) {
  return std::make_unique<WorldView>(run, options);
}

}  // namespace shoal::actor

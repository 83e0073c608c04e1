// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/frame_recorder.h"

#include <cmath>

#include "actor/worlds/custom_cameras.h"
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
  // The view is no input of the policy: it always shows the goal's marker.
  observation.goal_mode = "none";
  config.replay.hindsight = "none";
  observation.quality = options.quality;
  return config;
}

std::unique_ptr<worlds::Environment> MakeView(const Config& config) {
  return worlds::MakeEnvironment(config, worlds::MakeRenderContext(config.observation));
}

// Simulated time of one env step; 0 = unknown. Plays one step.
uint32_t StepMicroseconds(worlds::Environment& environment, worlds::ObservationOut out) {
  try {
    environment.Reset(0, out);
    const double start = environment.simulated_seconds();
    environment.Step(std::vector<float>(size_t(environment.spec().action_size), 0.0F), out);
    return static_cast<uint32_t>(std::lround(1e6 * (environment.simulated_seconds() - start)));
  } catch (const worlds::EpisodeFault&) {
    return 0;
  }
}

image::FrameStreamHeader HeaderOf(const ObservationSpec& seen, const ObservationSpec& view,
                                  uint32_t step_microseconds) {
  return {.magic = {},
          .channels = static_cast<uint32_t>(seen.InputChannels()),
          .height = static_cast<uint32_t>(seen.height),
          .width = static_cast<uint32_t>(seen.width),
          .frame_channels = static_cast<uint32_t>(seen.channels),
          .view_height = static_cast<uint32_t>(view.height),
          .view_width = static_cast<uint32_t>(view.width),
          .action_size = static_cast<uint32_t>(seen.action_size),
          .step_microseconds = step_microseconds};
}

// Equal episodes are equally faulty.
[[noreturn]] void ThrowParted(const worlds::EpisodeFault& fault) {
  throw RuntimeError("the view's environment went another way than the policy's: {}", fault.what());
}

// (3, H, W) to (H, W, 3).
void Interleave(std::span<const uint8_t> planes, std::span<uint8_t> pixels) {
  const size_t plane = planes.size() / 3;
  for (size_t i = 0; i < plane; ++i) {
    for (size_t channel = 0; channel < 3; ++channel) {
      pixels[3 * i + channel] = planes[channel * plane + i];
    }
  }
}

}  // namespace

FrameRecorder::FrameRecorder(const RunConfig& run, const Options& options)
    : view_(MakeView(ViewConfig(run, options))),
      planes_(static_cast<size_t>(view_->spec().FrameBytes())),
      interleaved_(planes_.size()),
      vector_(static_cast<size_t>(view_->spec().RecordedVectorSize())),
      writer_(options.file,
              HeaderOf(run.spec, view_->spec(), StepMicroseconds(*view_, {planes_, vector_}))),
      no_action_(static_cast<size_t>(run.spec.action_size), 0.0F) {}

void FrameRecorder::OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) {
  try {
    view_->Reset(stream_key, {planes_, vector_});
  } catch (const worlds::EpisodeFault& fault) {
    ThrowParted(fault);
  }
  step_ = 0;
  running_ = true;
  Write({.episode = episode_, .step = step_, .reward = 0, .flags = 0}, no_action_, stack);
}

void FrameRecorder::OnStep(const SeenStep& step) {
  worlds::StepResult result;
  try {
    result = view_->Step(step.action, {planes_, vector_});
  } catch (const worlds::EpisodeFault& fault) {
    ThrowParted(fault);
  }
  CHECK(result.reward == step.reward) << "the view's environment went another way";
  ++step_;
  const uint32_t flags =
      (step.success ? image::kShownSuccess : 0U) | (step.ended ? image::kShownEnd : 0U);
  Write({.episode = episode_, .step = step_, .reward = step.reward, .flags = flags}, step.action,
        step.stack);
  if (step.ended) ++episode_;
  running_ = !step.ended;
}

void FrameRecorder::OnFault(std::span<const uint8_t> stack) {
  Write({.episode = episode_,
         .step = running_ ? step_ + 1 : 0,
         .reward = 0,
         .flags = image::kShownEnd},
        no_action_, stack);
  ++episode_;
  running_ = false;
}

void FrameRecorder::Write(const image::FrameRecordHeader& record, std::span<const float> action,
                          std::span<const uint8_t> stack) {
  Interleave(planes_, interleaved_);
  writer_.Write(record, action, stack, interleaved_);
}

}  // namespace shoal::actor

// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <memory>

#include "actor/worlds/environment.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kPictureSize = 84, kLargeSize = 480;

// Resizes channels of `from` x `from` pixels to `to` x `to`: each pixel is the mean of the pixels
// that it covers, including partly covered ones.
void ShrinkByArea(std::span<const uint8_t> in, int channels, int from, int to,
                  std::vector<uint8_t>* out) {
  out->resize(size_t(channels) * size_t(to) * size_t(to));
  const auto first = [=](int i) { return i * from / to; };
  const auto last = [=](int i) { return ((i + 1) * from - 1) / to; };
  uint8_t* pixel = out->data();
  for (int c = 0; c < channels; ++c) {
    const uint8_t* plane = in.data() + size_t(c) * size_t(from) * size_t(from);
    for (int i = 0; i < to; ++i) {
      for (int j = 0; j < to; ++j) {
        int sum = 0, count = 0;
        for (int y = first(i); y <= last(i); ++y) {
          for (int x = first(j); x <= last(j); ++x, ++count) sum += plane[y * from + x];
        }
        *pixel++ = uint8_t(sum / count);
      }
    }
  }
}

// One environment stepped for ever with a fixed action. Frames of other sizes are resized to 84x84.
class Stepper {
 public:
  Stepper(const std::string& task, const std::vector<std::string>& cameras,
          const std::string& quality, int size, const std::string& goal_mode)
      : size_(size) {
    const bool pixels = !cameras.empty();
    Config config;
    config.task = task;
    config.observation.goal_mode = goal_mode;
    config.observation.pixels = pixels;
    config.observation.cameras = cameras;
    config.observation.quality = quality;
    config.observation.height = config.observation.width = size;
    std::shared_ptr<worlds::RenderContext> render;
    if (pixels) render = worlds::MakeRenderContext(config.observation);
    environment_ = worlds::MakeEnvironment(config, render);
    frame_.resize(size_t(environment_->spec().FrameBytes()));
    vector_.resize(size_t(environment_->spec().RecordedVectorSize()));
    action_ = {0.3f, -0.2f, 0.1f};
    action_.resize(size_t(environment_->spec().action_size));
  }

  void Step() {
    if (!running_) environment_->Reset(++episode_, {frame_, vector_});
    const worlds::StepResult result = environment_->Step(action_, {frame_, vector_});
    running_ = !result.truncated && !result.terminated;
    if (size_ != kPictureSize) {
      ShrinkByArea(frame_, environment_->spec().channels, size_, kPictureSize, &shrunk_);
    }
  }

 private:
  std::unique_ptr<worlds::Environment> environment_;
  const int size_;
  std::vector<uint8_t> frame_, shrunk_;
  std::vector<float> vector_, action_;
  uint64_t episode_ = 0;
  bool running_ = false;
};

}  // namespace

std::vector<Pairing> WorldPairings() {
  // An environment is made with its first step, which is not timed: --only leaves most of them
  // out.
  const auto make = [](const std::string& task, const std::vector<std::string>& cameras,
                       const std::string& quality, int size = kPictureSize,
                       const std::string& goal_mode = "none") {
    const auto stepper = std::make_shared<std::unique_ptr<Stepper>>();
    return [=] {
      if (!*stepper) *stepper = std::make_unique<Stepper>(task, cameras, quality, size, goal_mode);
      (*stepper)->Step();
    };
  };
  std::vector<Pairing> pairings;
  for (const std::string task : {"FetchReach", "FetchPush", "FetchSlide", "FetchPickAndPlace"}) {
    const auto physics = make(task, {}, "fast");
    pairings.push_back({.stage = task + " with one 84x84 camera, fast",
                        .unit = "env steps/s",
                        .against = "physics alone",
                        .target = 0.5,
                        .ours = make(task, {"front"}, "fast"),
                        .other = physics});
    pairings.push_back({.stage = task + " with two 84x84 cameras, fast",
                        .unit = "env steps/s",
                        .against = "physics alone",
                        .target = 0.35,
                        .ours = make(task, {"front", "side"}, "fast"),
                        .other = physics});
    pairings.push_back({.stage = task + " with one 84x84 camera, native",
                        .unit = "env steps/s",
                        .against = "physics alone",
                        .target = 0.9,
                        .ours = make(task, {"front"}, "native"),
                        .other = physics});
  }
  const std::pair<const char*, const char*> others[] = {
      {"Hopper-v5", "track"},  {"cartpole_swingup", "fixed"}, {"reacher_easy", "fixed"},
      {"cheetah_run", "side"}, {"ball_in_cup_catch", "cam0"}, {"finger_spin", "cam0"},
      {"walker_walk", "side"}};
  for (const auto& [task, camera] : others) {
    pairings.push_back({.stage = std::string(task) + " with one 84x84 camera, fast",
                        .unit = "env steps/s",
                        .against = "physics alone",
                        .ours = make(task, {camera}, "fast"),
                        .other = make(task, {}, "fast")});
    pairings.push_back({.stage = std::string(task) + " with one 84x84 camera, native",
                        .unit = "env steps/s",
                        .against = "physics alone",
                        .target = 0.5,
                        .ours = make(task, {camera}, "native"),
                        .other = make(task, {}, "native")});
  }
  for (const std::string task : {"FetchReach", "FetchPush"}) {
    const auto with_goals = [&](const char* goal_mode) {
      return make(task, {"front", "side"}, "fast", kPictureSize, goal_mode);
    };
    pairings.push_back({.stage = task + " with two 84x84 cameras and a goal picture an episode",
                        .unit = "env steps/s",
                        .against = "without goal pictures",
                        .ours = with_goals("image"),
                        .other = with_goals("none")});
  }
  pairings.push_back({.stage = "FetchReach with two 84x84 cameras, fast",
                      .unit = "env steps/s",
                      .against = "quality reference",
                      .ours = make("FetchReach", {"front", "side"}, "fast"),
                      .other = make("FetchReach", {"front", "side"}, "reference")});
  for (const char* quality : {"fast", "reference"}) {
    pairings.push_back({.stage = fmt::format("FetchReach with one 84x84 camera, {}", quality),
                        .unit = "env steps/s",
                        .against = "drawn at 480x480, then resized",
                        .ours = make("FetchReach", {"front"}, quality),
                        .other = make("FetchReach", {"front"}, quality, kLargeSize)});
  }
  return pairings;
}

}  // namespace shoal::bench

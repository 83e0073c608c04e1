#include <memory>

#include "actor/worlds/environment.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

// One environment stepped for ever with a fixed action.
class Stepper {
 public:
  Stepper(const std::string& task, const std::vector<std::string>& cameras,
          const std::string& quality) {
    const bool pixels = !cameras.empty();
    Config config;
    config.task = task;
    config.observation.pixels = pixels;
    config.observation.cameras = cameras;
    config.observation.quality = quality;
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
  }

 private:
  std::unique_ptr<worlds::Environment> environment_;
  std::vector<uint8_t> frame_;
  std::vector<float> vector_, action_;
  uint64_t episode_ = 0;
  bool running_ = false;
};

}  // namespace

std::vector<Pairing> WorldPairings() {
  const auto make = [](const std::string& task, const std::vector<std::string>& cameras,
                       const char* quality) {
    const auto stepper = std::make_shared<Stepper>(task, cameras, quality);
    return [stepper] { stepper->Step(); };
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
  }
  pairings.push_back({.stage = "FetchReach with two 84x84 cameras, fast",
                      .unit = "env steps/s",
                      .against = "quality reference",
                      .ours = make("FetchReach", {"front", "side"}, "fast"),
                      .other = make("FetchReach", {"front", "side"}, "reference")});
  return pairings;
}

}  // namespace shoal::bench

#include <memory>

#include "actor/worlds/environment.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

// One environment stepped for ever with a fixed action.
class Stepper {
 public:
  Stepper(bool pixels, const std::vector<std::string>& cameras, const std::string& quality) {
    Config config;
    config.observation.pixels = pixels;
    config.observation.cameras = cameras;
    config.observation.quality = quality;
    std::shared_ptr<worlds::RenderContext> render;
    if (pixels) render = worlds::MakeRenderContext(config.observation);
    environment_ = worlds::MakeEnvironment(config, render);
    frame_.resize(size_t(environment_->spec().FrameBytes()));
    vector_.resize(size_t(environment_->spec().VectorSize()));
  }

  void Step() {
    if (!running_) environment_->Reset(++episode_, {frame_, vector_});
    const float action[4] = {0.3f, -0.2f, 0.1f, 0};
    running_ = !environment_->Step(action, {frame_, vector_}).truncated;
  }

 private:
  std::unique_ptr<worlds::Environment> environment_;
  std::vector<uint8_t> frame_;
  std::vector<float> vector_;
  uint64_t episode_ = 0;
  bool running_ = false;
};

}  // namespace

std::vector<Pairing> WorldPairings() {
  const auto make = [](bool pixels, std::vector<std::string> cameras, const char* quality) {
    const auto stepper = std::make_shared<Stepper>(pixels, cameras, quality);
    return [stepper] { stepper->Step(); };
  };
  const auto physics = make(false, {}, "fast");
  const auto two = make(true, {"front", "side"}, "fast");
  return {{.stage = "FetchReachDense with one 84x84 camera, fast",
           .unit = "env steps/s",
           .against = "physics alone",
           .target = 0.5,
           .ours = make(true, {"front"}, "fast"),
           .other = physics},
          {.stage = "FetchReachDense with two 84x84 cameras, fast",
           .unit = "env steps/s",
           .against = "physics alone",
           .target = 0.35,
           .ours = two,
           .other = physics},
          {.stage = "FetchReachDense with two 84x84 cameras, fast",
           .unit = "env steps/s",
           .against = "quality reference",
           .ours = two,
           .other = make(true, {"front", "side"}, "reference")}};
}

}  // namespace shoal::bench

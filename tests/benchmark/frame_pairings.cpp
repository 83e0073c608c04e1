// SPDX-License-Identifier: Apache-2.0
// Frames drawn in quality native beside the same frames in quality fast.
#include <fmt/core.h>

#include <memory>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/render_context.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"
#include "common/tasks/task_registry.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {
namespace {

constexpr int kSide = 84;
constexpr int kStates = 12;       // drawn in turn, as the environments of one actor are
constexpr int kStepsBetween = 4;  // random ones, from one state to the next

// Draws the states of one task in turn, without stepping them.
class Drawer {
 public:
  Drawer(const std::string& task_name, const std::string& camera, const std::string& quality) {
    const tasks::Task& task = tasks::FindTask(task_name);
    ObservationConfig observation;
    observation.height = observation.width = kSide;
    observation.quality = quality;
    render_ = worlds::MakeRenderContext(observation);
    frame_.resize(3 * kSide * kSide);
    std::vector<double> action(static_cast<size_t>(task.action_size()));
    for (uint64_t state = 0; state < kStates; ++state) {
      auto& world = worlds_.emplace_back(worlds::MakeWorld(task.world(), {}));
      Random random(state);
      world->Reset(&random);
      for (uint64_t step = 0; step < state * kStepsBetween; ++step) {
        for (double& component : action) component = random.Uniform(-1, 1);
        if (world->Step(action).terminated) break;
      }
      render_->Attach(world.get());
      world->ReleaseTextures();
    }
    camera_ = worlds::FindCamera(*worlds_[0], camera);
  }

  void Draw() { render_->Render(worlds_[next_++ % kStates].get(), {&camera_, 1}, frame_); }

 private:
  std::shared_ptr<worlds::RenderContext> render_;
  std::vector<std::unique_ptr<worlds::World>> worlds_;
  worlds::CameraView camera_;
  std::vector<uint8_t> frame_;
  size_t next_ = 0;
};

}  // namespace

std::vector<Pairing> FramePairings() {
  // Worlds are made with the first frame, which is not timed: --only leaves most of them out.
  const auto make = [](const std::string& task, const std::string& camera,
                       const std::string& quality) {
    const auto drawer = std::make_shared<std::unique_ptr<Drawer>>();
    return [=] {
      if (!*drawer) *drawer = std::make_unique<Drawer>(task, camera, quality);
      (*drawer)->Draw();
    };
  };
  struct Drawn {
    const char *task, *camera;
    double target;
  };
  constexpr Drawn kDrawn[] = {{"FetchReach", "front", 6},        {"FetchPush", "front", 6},
                              {"FetchPush", "side", 6},          {"FetchPush", "close", 6},
                              {"FetchSlide", "front", 6},        {"FetchPush", "wrist", 6},
                              {"FetchPickAndPlace", "front", 6}, {"Hopper-v5", "track", 8},
                              {"cartpole_swingup", "fixed", 8},  {"reacher_easy", "fixed", 8},
                              {"cheetah_run", "side", 8},        {"ball_in_cup_catch", "cam0", 8},
                              {"finger_spin", "cam0", 8},        {"walker_walk", "side", 8}};
  std::vector<Pairing> pairings;
  for (const Drawn& drawn : kDrawn) {
    pairings.push_back(
        {.stage = fmt::format("84x84 frame of {} {}, native", drawn.task, drawn.camera),
         .unit = "frames/s",
         .against = "quality fast",
         .target = drawn.target,
         .ours = make(drawn.task, drawn.camera, "native"),
         .other = make(drawn.task, drawn.camera, "fast")});
  }
  return pairings;
}

}  // namespace shoal::bench

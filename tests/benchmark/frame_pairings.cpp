// SPDX-License-Identifier: Apache-2.0
// Frames drawn in quality native, compared with the same frames in quality fast.
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
// States drawn in turn, like the environments of one actor. There are more states than the renderer
// can cache for a moving camera, so no state is drawn from the cache.
constexpr uint64_t kFixedStates = 12, kMovingStates = 100;
constexpr uint64_t kStepsBetween = 4;  // random ones, from one state to the next

// Draws the states of one task in turn, without stepping them.
class Drawer {
 public:
  Drawer(const std::string& task_name, const std::string& camera, const std::string& quality,
         uint64_t states) {
    const tasks::Task& task = tasks::FindTask(task_name);
    ObservationConfig observation;
    observation.height = observation.width = kSide;
    observation.quality = quality;
    render_ = worlds::MakeRenderContext(observation);
    frame_.resize(3 * kSide * kSide);
    std::vector<double> action(static_cast<size_t>(task.action_size()));
    for (uint64_t state = 0; state < states; ++state) {
      auto& world = worlds_.emplace_back(worlds::MakeWorld(task.world(), {}));
      Random random(state);
      world->Reset(&random);
      for (uint64_t step = 0; step < state % kFixedStates * kStepsBetween; ++step) {
        for (double& component : action) component = random.Uniform(-1, 1);
        if (world->Step(action).terminated) break;
      }
      render_->Attach(world.get());
      world->ReleaseTextures();
    }
    camera_ = worlds::FindCamera(*worlds_[0], camera);
  }

  void Draw() { render_->Render(worlds_[next_++ % worlds_.size()].get(), {&camera_, 1}, frame_); }

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
  struct Drawn {
    const char *task, *camera;
    double target;
    uint64_t states;
  };
  constexpr Drawn kDrawn[] = {{"FetchReach", "front", 6, kFixedStates},
                              {"FetchPush", "front", 6, kFixedStates},
                              {"FetchPush", "side", 6, kFixedStates},
                              {"FetchPush", "close", 6, kFixedStates},
                              {"FetchPush", "wrist", 6, kMovingStates},
                              {"FetchSlide", "front", 6, kFixedStates},
                              {"FetchPickAndPlace", "front", 6, kFixedStates},
                              {"Hopper-v5", "track", 8, kMovingStates},
                              {"cartpole_swingup", "fixed", 8, kFixedStates},
                              {"cartpole_swingup", "lookatcart", 8, kMovingStates},
                              {"reacher_easy", "fixed", 8, kFixedStates},
                              {"cheetah_run", "side", 8, kMovingStates},
                              {"ball_in_cup_catch", "cam0", 8, kFixedStates},
                              {"finger_spin", "cam0", 8, kFixedStates},
                              {"walker_walk", "side", 8, kMovingStates}};
  const auto make = [](const Drawn& drawn, const std::string& quality) {
    const auto drawer = std::make_shared<std::unique_ptr<Drawer>>();
    return [=] {
      if (!*drawer) {
        *drawer = std::make_unique<Drawer>(drawn.task, drawn.camera, quality, drawn.states);
      }
      (*drawer)->Draw();
    };
  };
  std::vector<Pairing> pairings;
  for (const Drawn& drawn : kDrawn) {
    pairings.push_back(
        {.stage = fmt::format("84x84 frame of {} {}, native", drawn.task, drawn.camera),
         .unit = "frames/s",
         .against = "quality fast",
         .target = drawn.target,
         .ours = make(drawn, "native"),
         .other = make(drawn, "fast")});
  }
  return pairings;
}

}  // namespace shoal::bench

// SPDX-License-Identifier: Apache-2.0
// Pictures of quality native beside those of the engine's own renderer, for every physics half and
// camera. SHOAL_PICTURE_STATES sets how many states of each are drawn.
#include <fmt/core.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "actor/worlds/abstract_scene.h"
#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/episode_fault.h"
#include "actor/worlds/native/renderer.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"
#include "common/tasks/task_registry.h"
#include "tests/actor/worlds/native/scene_by_hand.h"
#include "tests/actor/worlds/native/unshadowed_reference.h"

namespace shoal::worlds::native {
namespace {

constexpr int kSide = 84;
constexpr size_t kPixels = kSide * kSide;

int StatesPerCamera() {
  const char* asked = std::getenv("SHOAL_PICTURE_STATES");
  return asked == nullptr ? 8 : std::atoi(asked);
}

// One task of each physics half.
std::vector<std::string> Tasks() {
  std::vector<std::string> chosen;
  std::set<std::string> worlds;
  for (const std::string& name : tasks::TaskNames()) {
    if (worlds.insert(tasks::FindTask(name).world()).second) chosen.push_back(name);
  }
  return chosen;
}

// A world under random actions, started anew when an episode ends.
class RandomStates {
 public:
  explicit RandomStates(const std::string& task)
      : task_(tasks::FindTask(task)), world_(MakeWorld(task_.world(), {})) {
    Reset();
  }
  World* world() { return world_.get(); }

  void Next() {
    std::vector<double> action(static_cast<size_t>(task_.action_size()));
    for (int step = 0; step < 3; ++step) {
      for (double& component : action) component = random_.Uniform(-1, 1);
      bool over = ++steps_ >= task_.episode_length();
      try {
        over = world_->Step(action).terminated || over;
      } catch (const EpisodeFault&) {
        world_->ForgetDivergence();
        over = true;
      }
      if (over) Reset();
    }
  }

 private:
  void Reset() {
    steps_ = 0;
    world_->Reset(&random_);
  }

  const tasks::Task& task_;
  std::unique_ptr<World> world_;
  Random random_{11};
  int steps_ = 0;
};

double MeanDifference(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += std::abs(int{a[i]} - int{b[i]});
  return sum / static_cast<double>(a.size());
}

// Intersection over union of all segments together.
double Agreement(const std::vector<int>& a, const std::vector<int>& b) {
  double same = 0;
  for (size_t i = 0; i < a.size(); ++i) same += a[i] == b[i];
  const double all = 2 * static_cast<double>(a.size()) - same;
  return same / all;
}

class Pictures : public testing::TestWithParam<std::string> {};

TEST_P(Pictures, LookLikeTheReferenceWithoutShadows) {
  RandomStates states(GetParam());
  World* world = states.world();
  UnshadowedReference reference(&world->model(), kSide, kSide);
  Renderer renderer(world->model());
  AbstractScene scene;
  scene.Allocate(*world);
  for (const CameraView& camera : CamerasOf(*world)) {
    double sum = 0, most = 0, least_agreement = 1, agreement = 0;
    for (int state = 0; state < StatesPerCamera(); ++state) {
      states.Next();
      scene.Update(world, camera);
      std::vector<uint8_t> ours(3 * kPixels);
      renderer.Draw(scene.scene(), kSide, kSide, ours);
      std::vector<int32_t> numbers(kPixels);
      renderer.DrawNumbers(scene.scene(), kSide, kSide, numbers);
      for (int32_t& number : numbers) {
        if (number >= 0) number = scene.scene().geoms[number].segid;
      }
      const double difference = MeanDifference(ours, reference.Draw(&scene.scene()));
      const double same = Agreement(numbers, reference.DrawSegments(&scene.scene()));
      sum += difference;
      most = std::max(most, difference);
      agreement += same;
      least_agreement = std::min(least_agreement, same);
    }
    const double mean = sum / StatesPerCamera();
    std::cout << fmt::format(
        "{} {}: {:.2f} grey levels, at most {:.2f}; segments {:.4f}, at least {:.4f}\n", GetParam(),
        camera.name, mean, most, agreement / StatesPerCamera(), least_agreement);
    EXPECT_LE(mean, 4) << camera.name;
    EXPECT_LE(most, 12) << camera.name;
    EXPECT_GE(agreement / StatesPerCamera(), 0.98) << camera.name;
  }
}

TEST_P(Pictures, AreTheSameBitsOnAllInstructionSetsAndWithoutLayers) {
  RandomStates states(GetParam());
  World* world = states.world();
  std::vector<std::unique_ptr<Renderer>> renderers;
  for (const InstructionSet set : SupportedSets()) {
    renderers.push_back(std::make_unique<Renderer>(world->model(), set));
  }
  renderers.push_back(std::make_unique<Renderer>(world->model()));
  renderers.back()->KeepLayers(false);
  AbstractScene scene;
  scene.Allocate(*world);
  for (const CameraView& camera : CamerasOf(*world)) {
    for (int state = 0; state < StatesPerCamera(); ++state) {
      states.Next();
      scene.Update(world, camera);
      std::vector<uint8_t> first(3 * kPixels), other(3 * kPixels);
      renderers[0]->Draw(scene.scene(), kSide, kSide, first);
      for (size_t i = 1; i < renderers.size(); ++i) {
        renderers[i]->Draw(scene.scene(), kSide, kSide, other);
        ASSERT_EQ(first, other) << camera.name << ", state " << state << ", renderer " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, Pictures, testing::ValuesIn(Tasks()), [](const auto& task) {
  std::string name = task.param;
  std::ranges::replace_if(
      name, [](char c) { return !isalnum(c); }, '_');
  return name;
});

}  // namespace
}  // namespace shoal::worlds::native

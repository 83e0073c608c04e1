// Physics half: model, reset, step, what can be seen.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>

#include "actor/worlds/model_text.h"
#include "actor/worlds/world.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"

namespace {

using shoal::worlds::CameraView;

constexpr char kModel[] = R"(
<mujoco model="point">
  <option timestep="0.01"/>
  <worldbody>
    <light pos="0 0 2" dir="0 0 -1" directional="true" castshadow="false"/>
    <geom name="floor" type="plane" size="0.6 0.6 1" rgba="0.8 0.8 0.8 1"/>
    <!-- Not at its body's origin: the engine would not look at site_pos (docs/own_task.md). -->
    <site name="target" pos="0 0 0.001" type="sphere" size="0.05" rgba="1 0 0 1"/>
    <body name="point" pos="0 0 0.04">
      <joint name="x" type="slide" axis="1 0 0" damping="1"/>
      <joint name="y" type="slide" axis="0 1 0" damping="1"/>
      <geom type="sphere" size="0.04" mass="0.1" rgba="0 0 1 1" contype="0"
            conaffinity="0"/>
    </body>
  </worldbody>
  <actuator>
    <motor joint="x" ctrlrange="-1 1" ctrllimited="true"/>
    <motor joint="y" ctrlrange="-1 1" ctrllimited="true"/>
  </actuator>
</mujoco>)";

constexpr int kEngineStepsPerEnvStep = 4;  // 0.04 s
constexpr double kGoalRange = 0.3;         // m, each axis

class PointReach final : public shoal::worlds::World {
 public:
  explicit PointReach(const shoal::worlds::WorldOptions& options)
      : World(shoal::worlds::LoadModelText(kModel, options.model)), target_(SiteId("target")) {}

  // Draws the goal: x, then y.
  void Reset(shoal::Random* random) override {
    mj_resetData(&model(), &data());
    for (double& coordinate : goal_) coordinate = random->Uniform(-kGoalRange, kGoalRange);
    PlaceSite(target_, std::array{goal_[0], goal_[1], 0.0});
    mj_forward(&model(), &data());
  }

  Outcome Step(std::span<const double> action) override {
    SetControls(action);
    Advance(kEngineStepsPerEnvStep);
    return {};
  }

  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override {
    std::copy_n(data().qpos, 2, observation.begin());
    std::copy_n(data().qvel, 2, observation.begin() + 2);
    std::copy_n(data().qpos, 2, achieved_goal.begin());
    std::copy_n(goal_.begin(), 2, desired_goal.begin());
  }

  std::span<const CameraView> cameras() const override {
    static const CameraView top{"top", {0, 0, 0}, 1.6, 90, -90};
    return {&top, 1};
  }

 private:
  int target_;
  std::array<double, 2> goal_{};
};

std::unique_ptr<shoal::worlds::World> MakePhysicsHalf(const shoal::worlds::WorldOptions& options) {
  return std::make_unique<PointReach>(options);
}

}  // namespace

extern "C" void ShoalRegisterPhysics() { shoal::worlds::AddWorld("PointReach", MakePhysicsHalf); }

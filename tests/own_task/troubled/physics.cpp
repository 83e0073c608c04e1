// SPDX-License-Identifier: Apache-2.0
// Faulty physics halves.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "actor/worlds/model_text.h"
#include "actor/worlds/world.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"

namespace {

using shoal::worlds::CameraView;
using shoal::worlds::WorldOptions;

enum class Trouble {
  kLong,      // writes a number more than the goal half has
  kShort,     // does not write the last one
  kConstant,  // writes a zero in its place
  kSensor,    // y is NaN from the 6th step on, in one episode of thirty
  kAlways,    // the same in every episode
  kReset,     // y is NaN at the reset of one episode of thirty
  kDiverged,  // the engine's state is, from the 6th step on, in one episode of thirty
  kReward,    // the reward is NaN at the 6th step, in one episode of thirty
  kTalk,      // prints a line to standard output at each step
  kCamera,    // has a camera in its model alone
  kControls,  // the action has a number more than the model has actuators
};

constexpr char kModel[] = R"(
<mujoco model="point">
  <option timestep="0.02"/>
  <worldbody>
    <light pos="0 0 2" dir="0 0 -1" directional="true" castshadow="false"/>
    <camera name="overhead" pos="0 0 1.5"/>
    <camera name="low" pos="0 -1 0.3" xyaxes="1 0 0 0 0.3 1"/>
    <geom name="floor" type="plane" size="0.6 0.6 1" rgba="0.8 0.8 0.8 1"/>
    <body name="point" pos="0 0 0.04">
      <joint name="x" type="slide" axis="1 0 0" damping="1"/>
      <joint name="y" type="slide" axis="0 1 0" damping="1"/>
      <geom type="sphere" size="0.04" mass="0.1" rgba="0 0 1 1" contype="0" conaffinity="0"/>
    </body>
  </worldbody>
  <actuator>
    <motor joint="x" ctrlrange="-1 1" ctrllimited="true"/>
    <motor joint="y" ctrlrange="-1 1" ctrllimited="true"/>
  </actuator>
</mujoco>)";

constexpr double kRare = 1.0 / 30;  // share of the episodes
constexpr int kWhen = 6;            // step

class Troubled final : public shoal::worlds::World {
 public:
  Troubled(Trouble trouble, const WorldOptions& options)
      : World(shoal::worlds::LoadModelText(kModel, options.model), options.model),
        trouble_(trouble) {}

  void Reset(shoal::Random* random) override {
    mj_resetData(&model(), &data());
    for (double& coordinate : goal_) coordinate = random->Uniform(-0.3, 0.3);
    struck_ = random->Uniform() < kRare || trouble_ == Trouble::kAlways;
    step_ = 0;
    mj_forward(&model(), &data());
  }

  Outcome Step(std::span<const double> action) override {
    ++step_;
    if (trouble_ == Trouble::kTalk) {
      std::printf("hello from a robot driver\n");
      std::fflush(stdout);
    }
    if (trouble_ == Trouble::kControls) {
      SetControls(action);
    } else {
      std::copy_n(action.begin(), 2, data().ctrl);
    }
    if (struck_ && trouble_ == Trouble::kDiverged && step_ >= kWhen) data().qvel[0] = 1e20;
    Advance(2);
    const bool bad = struck_ && trouble_ == Trouble::kReward && step_ == kWhen;
    return {.reward = bad ? std::numeric_limits<double>::quiet_NaN() : 1};
  }

  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override {
    std::copy_n(data().qpos, 2, observation.begin());
    std::copy_n(data().qvel, trouble_ == Trouble::kShort ? 1 : 2, observation.begin() + 2);
    if (trouble_ == Trouble::kLong) observation.data()[4] = 7;
    if (trouble_ == Trouble::kConstant) observation[3] = 0;
    const bool sensor = trouble_ == Trouble::kSensor || trouble_ == Trouble::kAlways;
    if (struck_ && ((sensor && step_ >= kWhen) || (trouble_ == Trouble::kReset && step_ == 0))) {
      observation[1] = std::nan("");
    }
    if (achieved_goal.empty()) return;
    std::copy_n(data().qpos, 2, achieved_goal.begin());
    std::copy_n(goal_.begin(), 2, desired_goal.begin());
  }

  std::span<const CameraView> cameras() const override {
    static const CameraView top{"top", {0, 0, 0}, 1.6, 90, -90};
    if (trouble_ == Trouble::kCamera) return {};
    return {&top, 1};
  }

 private:
  const Trouble trouble_;
  std::array<double, 2> goal_{};
  bool struck_ = false;  // the episode is one that goes wrong
  int step_ = 0;
};

template <Trouble trouble>
std::unique_ptr<shoal::worlds::World> Make(const WorldOptions& options) {
  return std::make_unique<Troubled>(trouble, options);
}

std::unique_ptr<shoal::worlds::World> MakeNothing(const WorldOptions&) { return nullptr; }

}  // namespace

extern "C" void ShoalRegisterPhysics() {
  if (std::getenv("TROUBLED_TALK") != nullptr) std::puts("hello from the loading of a driver");
  using shoal::worlds::AddWorld;
  AddWorld("TroubledLong", Make<Trouble::kLong>);
  AddWorld("TroubledShort", Make<Trouble::kShort>);
  AddWorld("TroubledConstant", Make<Trouble::kConstant>);
  AddWorld("TroubledSensor", Make<Trouble::kSensor>);
  AddWorld("TroubledAlways", Make<Trouble::kAlways>);
  AddWorld("TroubledReset", Make<Trouble::kReset>);
  AddWorld("TroubledDiverged", Make<Trouble::kDiverged>);
  AddWorld("TroubledReward", Make<Trouble::kReward>);
  AddWorld("TroubledTalk", Make<Trouble::kTalk>);
  AddWorld("TroubledCamera", Make<Trouble::kCamera>);
  AddWorld("TroubledControls", Make<Trouble::kControls>);
  AddWorld("TroubledNothing", MakeNothing);
}

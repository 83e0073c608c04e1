// SPDX-License-Identifier: Apache-2.0
// Physics half of a two-link arm: its MJCF, with meshes and cameras, is a file beside the library.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "actor/worlds/model_cameras.h"
#include "actor/worlds/model_text.h"
#include "actor/worlds/world.h"
#include "actor/worlds/world_registry.h"
#include "common/base/random.h"

namespace {

using shoal::worlds::CameraView;
using shoal::worlds::WorldOptions;

constexpr char kModel[] = "model/arm.xml";
constexpr int kEngineStepsPerEnvStep = 4;  // 0.04 s

class ArmReach final : public shoal::worlds::World {
 public:
  explicit ArmReach(const WorldOptions& options)
      : World(shoal::worlds::LoadModelFile(options, kModel), options.ModelOr(kModel)),
        target_(SiteId("target")),
        tip_(SiteId("tip")),
        cameras_(shoal::worlds::ModelCameras(model())) {}

  // Draws the goal's distance from the shoulder, then its direction.
  void Reset(shoal::Random* random) override {
    mj_resetData(&model(), &data());
    const double distance = random->Uniform(0.15, 0.35);
    const double direction = random->Uniform(-std::numbers::pi / 2, std::numbers::pi / 2);
    goal_ = {distance * std::cos(direction), distance * std::sin(direction)};
    PlaceSite(target_, std::array{goal_[0], goal_[1], 0.05});
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
    std::copy_n(data().site_xpos + 3 * tip_, 2, achieved_goal.begin());
    std::copy_n(goal_.begin(), 2, desired_goal.begin());
  }

  std::span<const CameraView> cameras() const override { return cameras_; }

 private:
  const int target_, tip_;
  const std::vector<CameraView> cameras_;
  std::array<double, 2> goal_{};
};

std::unique_ptr<shoal::worlds::World> Make(const WorldOptions& options) {
  return std::make_unique<ArmReach>(options);
}

}  // namespace

extern "C" void ShoalRegisterPhysics() { shoal::worlds::AddWorld("ArmReach", Make); }

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/ball_in_cup_catch.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::worlds {

constexpr int kJoints = 4, kActuators = 2, kEngineSteps = 10;

std::unique_ptr<World> MakeBallInCupCatch(const std::string& model_file) {
  return std::make_unique<BallInCupCatch>(model_file);
}

BallInCupCatch::BallInCupCatch(const std::string& model_file)
    : ControlWorld("ball_in_cup.xml", model_file, {kJoints, kActuators, kEngineSteps}),
      ball_joint_(model().jnt_qposadr[JointId("ball_x")]),
      ball_(BodyId("ball")),
      ball_geom_(GeomId("ball")),
      target_(SiteId("target")) {}

void BallInCupCatch::Draw(Random* random) {
  DrawUntilFree([&] {
    data().qpos[ball_joint_] = random->Uniform(-0.2, 0.2);
    data().qpos[ball_joint_ + 1] = random->Uniform(0.2, 0.5);
  });
}

void BallInCupCatch::Observe(std::span<double> observation, std::span<double>,
                             std::span<double>) const {
  CHECK(observation.size() == 2 * kJoints) << observation.size();
  std::copy_n(data().qvel, kJoints, std::copy_n(data().qpos, kJoints, observation.begin()));
}

double BallInCupCatch::Reward() const {
  const double* ball = data().xpos + 3 * ball_;
  const double* target = data().site_xpos + 3 * target_;
  const double* half = model().site_size + 3 * target_;
  const double radius = model().geom_size[3 * ball_geom_];
  const auto inside = [&](int axis) {
    return std::fabs(target[axis] - ball[axis]) < half[axis] - radius;
  };
  return inside(0) && inside(2) ? 1 : 0;
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/walker_walk.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "actor/worlds/reward_tolerance.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {

constexpr int kJoints = 9, kActuators = 6, kEngineSteps = 10;
constexpr int kPitch = 2;             // hinge of the torso, the only hinge without limits
constexpr int kBodies = 7;            // torso, right thigh, leg, foot, left thigh, leg, foot
constexpr double kStandHeight = 1.2;  // m
constexpr double kWalkSpeed = 1;      // m/s
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::unique_ptr<World> MakeWalkerWalk(const std::string& model_file) {
  return std::make_unique<WalkerWalk>(model_file);
}

WalkerWalk::WalkerWalk(const std::string& model_file)
    : ControlWorld("walker.xml", model_file, {kJoints, kActuators, kEngineSteps}),
      torso_(BodyId("torso")),
      velocity_(model().sensor_adr[SensorId("torso_velocity")]) {
  if (model().nbody < torso_ + kBodies) {
    throw RuntimeError("the model has {} bodies from its torso on; expected {}",
                       model().nbody - torso_, kBodies);
  }
}

void WalkerWalk::Draw(Random* random) {
  data().qpos[kPitch] = random->Uniform(-M_PI, M_PI);
  for (int joint = kPitch + 1; joint < kJoints; ++joint) {
    const double* range = model().jnt_range + 2 * joint;
    data().qpos[joint] = random->Uniform(range[0], range[1]);
  }
}

void WalkerWalk::Observe(std::span<double> observation, std::span<double>,
                         std::span<double>) const {
  CHECK(observation.size() == 2 * kBodies + 1 + kJoints) << observation.size();
  auto out = observation.begin();
  for (int body = torso_; body < torso_ + kBodies; ++body) {
    *out++ = data().xmat[9 * body];      // xx
    *out++ = data().xmat[9 * body + 2];  // xz
  }
  *out++ = data().xpos[3 * torso_ + 2];
  std::copy_n(data().qvel, kJoints, out);
}

double WalkerWalk::Reward() const {
  const double standing =
      Tolerance(data().xpos[3 * torso_ + 2],
                {.low = kStandHeight, .high = kInfinity, .margin = kStandHeight / 2});
  const double upright = (1 + data().xmat[9 * torso_ + 8]) / 2;
  const double move = Tolerance(data().sensordata[velocity_], {.low = kWalkSpeed,
                                                               .high = kInfinity,
                                                               .margin = kWalkSpeed / 2,
                                                               .fall_off = FallOff::kLinear,
                                                               .value_at_margin = 0.5});
  return (3 * standing + upright) / 4 * (5 * move + 1) / 6;
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/cartpole_swingup.h"

#include <mujoco/mujoco.h>

#include <cmath>

#include "actor/worlds/reward_tolerance.h"
#include "common/base/check.h"

namespace shoal::worlds {

// The joints are the cart's, then the pole's.
constexpr int kJoints = 2, kActuators = 1, kEngineSteps = 1;
constexpr double kNoise = 0.01;  // standard deviation of every coordinate and velocity at the start

std::unique_ptr<World> MakeCartpoleSwingup(const std::string& model_file) {
  return std::make_unique<CartpoleSwingup>(model_file);
}

CartpoleSwingup::CartpoleSwingup(const std::string& model_file)
    : ControlWorld("cartpole.xml", model_file, {kJoints, kActuators, kEngineSteps}),
      pole_(BodyId("pole_1")) {}

void CartpoleSwingup::Draw(Random* random) {
  data().qpos[0] = kNoise * random->Normal();
  data().qpos[1] = M_PI + kNoise * random->Normal();
  for (int i = 0; i < kJoints; ++i) data().qvel[i] = kNoise * random->Normal();
}

void CartpoleSwingup::Observe(std::span<double> observation, std::span<double>,
                              std::span<double>) const {
  CHECK(observation.size() == 5) << observation.size();
  const double* rotation = data().xmat + 9 * pole_;
  observation[0] = data().qpos[0];
  observation[1] = rotation[8];  // zz
  observation[2] = rotation[2];  // xz
  observation[3] = data().qvel[0];
  observation[4] = data().qvel[1];
}

double CartpoleSwingup::Reward() const {
  const double upright = (data().xmat[9 * pole_ + 8] + 1) / 2;
  const double centered = (1 + Tolerance(data().qpos[0], {.margin = 2})) / 2;
  const double small_control =
      (4 + Tolerance(data().ctrl[0],
                     {.margin = 1, .fall_off = FallOff::kQuadratic, .value_at_margin = 0})) /
      5;
  const double small_velocity = (1 + Tolerance(data().qvel[1], {.margin = 5})) / 2;
  return upright * small_control * small_velocity * centered;
}

}  // namespace shoal::worlds

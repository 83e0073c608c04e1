// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/cheetah_run.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>

#include "actor/worlds/reward_tolerance.h"
#include "common/base/check.h"

namespace shoal::worlds {

constexpr int kJoints = 9, kActuators = 6, kEngineSteps = 1;
constexpr int kSettlingSteps = 200;
constexpr double kFullSpeed = 10;  // m/s

std::unique_ptr<World> MakeCheetahRun(const std::string& model_file) {
  return std::make_unique<CheetahRun>(model_file);
}

CheetahRun::CheetahRun(const std::string& model_file)
    : ControlWorld("cheetah.xml", model_file, {kJoints, kActuators, kEngineSteps}),
      velocity_(model().sensor_adr[SensorId("torso_velocity")]) {}

void CheetahRun::Draw(Random* random) {
  for (int joint = 0; joint < model().njnt; ++joint) {
    if (!model().jnt_limited[joint]) continue;
    const double* range = model().jnt_range + 2 * joint;
    data().qpos[model().jnt_qposadr[joint]] = random->Uniform(range[0], range[1]);
  }
}

void CheetahRun::Settle() {
  AdvanceControl(kSettlingSteps);
  data().time = 0;
}

void CheetahRun::Observe(std::span<double> observation, std::span<double>,
                         std::span<double>) const {
  CHECK(observation.size() == 2 * kJoints - 1) << observation.size();
  const auto out = std::copy(data().qpos + 1, data().qpos + kJoints, observation.begin());
  std::copy_n(data().qvel, kJoints, out);
}

double CheetahRun::Reward() const {
  return Tolerance(data().sensordata[velocity_], {.low = kFullSpeed,
                                                  .high = std::numeric_limits<double>::infinity(),
                                                  .margin = kFullSpeed,
                                                  .fall_off = FallOff::kLinear,
                                                  .value_at_margin = 0});
}

}  // namespace shoal::worlds

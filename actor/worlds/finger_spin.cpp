// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/finger_spin.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::worlds {

// The joints are proximal, distal and spinner.
constexpr int kJoints = 3, kActuators = 2, kEngineSteps = 2;
constexpr double kHingeDamping = 0.03;  // N m s/rad
constexpr double kSpin = -15;           // rad/s

std::unique_ptr<World> MakeFingerSpin(const std::string& model_file) {
  return std::make_unique<FingerSpin>(model_file);
}

FingerSpin::FingerSpin(const std::string& model_file)
    : ControlWorld("finger.xml", model_file, {kJoints, kActuators, kEngineSteps}),
      spinner_(BodyId("spinner")),
      tip_(SiteId("tip")),
      touch_top_(model().sensor_adr[SensorId("touchtop")]),
      touch_bottom_(model().sensor_adr[SensorId("touchbottom")]) {
  model().dof_damping[model().jnt_dofadr[JointId("hinge")]] = kHingeDamping;
  // Hides marks that belong to the suite's other tasks on this model.
  for (const int site : {tip_, SiteId("target")}) model().site_rgba[4 * site + 3] = 0;
}

void FingerSpin::Draw(Random* random) {
  DrawUntilFree([&] {
    for (int joint = 0; joint < kJoints; ++joint) {
      const double* range = model().jnt_range + 2 * joint;
      const bool limited = model().jnt_limited[joint];
      data().qpos[joint] =
          limited ? random->Uniform(range[0], range[1]) : random->Uniform(-M_PI, M_PI);
    }
  });
}

void FingerSpin::Observe(std::span<double> observation, std::span<double>,
                         std::span<double>) const {
  CHECK(observation.size() == 9) << observation.size();
  const double* tip = data().site_xpos + 3 * tip_;
  const double* spinner = data().xpos + 3 * spinner_;
  auto out = std::copy_n(data().qpos, 2, observation.begin());
  *out++ = tip[0] - spinner[0];
  *out++ = tip[2] - spinner[2];
  out = std::copy_n(data().qvel, kJoints, out);
  *out++ = std::log1p(data().sensordata[touch_top_]);
  *out++ = std::log1p(data().sensordata[touch_bottom_]);
}

double FingerSpin::Reward() const { return data().qvel[kJoints - 1] <= kSpin ? 1 : 0; }

}  // namespace shoal::worlds

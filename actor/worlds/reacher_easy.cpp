// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/reacher_easy.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "actor/worlds/reward_tolerance.h"
#include "common/base/check.h"

namespace shoal::worlds {

constexpr int kJoints = 2, kActuators = 2, kEngineSteps = 1;
constexpr double kTargetRadius = 0.05;                          // m
constexpr double kNearestTarget = 0.05, kFarthestTarget = 0.2;  // m, from the arm's root

std::unique_ptr<World> MakeReacherEasy(const std::string& model_file) {
  return std::make_unique<ReacherEasy>(model_file);
}

ReacherEasy::ReacherEasy(const std::string& model_file)
    : ControlWorld("reacher.xml", model_file, {kJoints, kActuators, kEngineSteps}),
      finger_(GeomId("finger")),
      target_(GeomId("target")) {
  model().geom_size[3 * target_] = kTargetRadius;
}

void ReacherEasy::Draw(Random* random) {
  const double* wrist = model().jnt_range + 2;
  data().qpos[0] = random->Uniform(-M_PI, M_PI);
  data().qpos[1] = random->Uniform(wrist[0], wrist[1]);
  const double angle = random->Uniform(0, 2 * M_PI);
  const double radius = random->Uniform(kNearestTarget, kFarthestTarget);
  PlaceTarget({radius * std::sin(angle), radius * std::cos(angle)});
}

void ReacherEasy::PlaceTarget(const std::array<double, 2>& position) {
  std::copy(position.begin(), position.end(), model().geom_pos + 3 * target_);
}

std::array<double, 2> ReacherEasy::ToTarget() const {
  const double* finger = data().geom_xpos + 3 * finger_;
  const double* target = data().geom_xpos + 3 * target_;
  return {target[0] - finger[0], target[1] - finger[1]};
}

void ReacherEasy::Observe(std::span<double> observation, std::span<double>,
                          std::span<double>) const {
  CHECK(observation.size() == 6) << observation.size();
  auto out = std::copy_n(data().qpos, kJoints, observation.begin());
  out = std::copy_n(ToTarget().begin(), 2, out);
  std::copy_n(data().qvel, kJoints, out);
}

double ReacherEasy::Reward() const {
  const auto [x, y] = ToTarget();
  const double reach = model().geom_size[3 * target_] + model().geom_size[3 * finger_];
  return Tolerance(std::hypot(x, y), {.low = 0, .high = reach});
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/hopper.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "actor/worlds/model_cameras.h"
#include "actor/worlds/model_loading.h"
#include "actor/worlds/model_sizes.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

constexpr int kJoints = 6;  // x, z and pitch of the torso; thigh, leg, foot
constexpr int kActions = 3;
constexpr double kResetNoise = 0.005;
constexpr double kHealthyReward = 1, kControlCost = 1e-3;
constexpr double kLowestHealthyZ = 0.7;       // m
constexpr double kLargestHealthyPitch = 0.2;  // rad
constexpr double kLargestHealthyState = 100;  // bound of every other coordinate and velocity
constexpr double kLargestVelocityShown = 10;
constexpr double kDensity = 1000;  // kg/m3

// MuJoCo up to 2.1.0 computed mass and inertia of a capsule of half length h and radius r like a
// cylinder of length 2 h + r.
struct OldCapsule {
  const char* body;
  double radius, half_length;  // m
};
constexpr OldCapsule kOldCapsules[] = {
    {"torso", 0.05, 0.2}, {"thigh", 0.05, 0.225}, {"leg", 0.04, 0.25}, {"foot", 0.06, 0.195}};

int FindBody(const mjModel& model, const char* name) {
  const int body = mj_name2id(&model, mjOBJ_BODY, name);
  if (body < 0) throw RuntimeError("the model has no body named '{}'", name);
  return body;
}

void WriteOldMasses(mjModel* model) {
  for (const OldCapsule& capsule : kOldCapsules) {
    const double r = capsule.radius, length = 2 * capsule.half_length + r;
    const double mass = kDensity * M_PI * r * r * length;
    const int body = FindBody(*model, capsule.body);
    model->body_mass[body] = mass;
    // The capsule's own frame is the principal frame, with the capsule's axis last.
    double* inertia = model->body_inertia + 3 * body;
    inertia[0] = inertia[1] = mass * (3 * r * r + length * length) / 12;
    inertia[2] = mass * r * r / 2;
  }
  const DataHandle data = MakeData(*model);
  mj_setConst(model, data.get());
}

// Changes the model before the world takes it, so that the fingerprint is that of the variant.
ModelHandle LoadVariant(const HopperVariant& variant, const std::string& model_file) {
  ModelHandle model = LoadModel("hopper.xml", model_file);
  CheckModelSizes(*model, kJoints, kActions);
  if (variant.old_masses) WriteOldMasses(model.get());
  if (variant.torso_mass_change != 0) {
    double& mass = model->body_mass[FindBody(*model, "torso")];
    mass += variant.torso_mass_change;
    if (mass <= 0) throw RuntimeError("the model's torso is lighter than what is taken from it");
  }
  return model;
}

}  // namespace

HopperVariant HopperV4() { return {.always_healthy_reward = true}; }
HopperVariant HopperV5() { return {}; }
HopperVariant CustomHopperTarget() {
  return {.old_masses = true, .always_healthy_reward = true, .clip_velocities = false};
}
HopperVariant CustomHopperSource() {
  HopperVariant variant = CustomHopperTarget();
  variant.torso_mass_change = -1;
  return variant;
}

std::unique_ptr<World> MakeHopperV4(const std::string& model_file) {
  return std::make_unique<Hopper>(HopperV4(), model_file);
}
std::unique_ptr<World> MakeHopperV5(const std::string& model_file) {
  return std::make_unique<Hopper>(HopperV5(), model_file);
}
std::unique_ptr<World> MakeCustomHopperSource(const std::string& model_file) {
  return std::make_unique<Hopper>(CustomHopperSource(), model_file);
}
std::unique_ptr<World> MakeCustomHopperTarget(const std::string& model_file) {
  return std::make_unique<Hopper>(CustomHopperTarget(), model_file);
}

Hopper::Hopper(const HopperVariant& variant, const std::string& model_file)
    : World(LoadVariant(variant, model_file), model_file),
      variant_(variant),
      cameras_(ModelCameras(model())) {
  cameras_.push_back({"free", {0, 0, 1.15}, 3.0, 90, -20});
}

void Hopper::Reset(Random* random) {
  std::array<double, kJoints> qpos{}, qvel{};
  for (int i = 0; i < kJoints; ++i) {
    qpos[size_t(i)] = model().qpos0[i] + random->Uniform(-kResetNoise, kResetNoise);
  }
  for (double& velocity : qvel) velocity = random->Uniform(-kResetNoise, kResetNoise);
  ResetTo(qpos, qvel);
}

void Hopper::ResetTo(std::span<const double> qpos, std::span<const double> qvel) {
  CHECK(qpos.size() == kJoints && qvel.size() == kJoints) << qpos.size() << ' ' << qvel.size();
  mj_resetData(&model(), &data());
  std::copy(qpos.begin(), qpos.end(), data().qpos);
  std::copy(qvel.begin(), qvel.end(), data().qvel);
  mj_forward(&model(), &data());
}

World::Outcome Hopper::Step(std::span<const double> action) {
  CHECK(action.size() == kActions) << action.size();
  const double x_before = data().qpos[0];
  std::copy(action.begin(), action.end(), data().ctrl);
  Advance(kEngineStepsPerControlStep);
  const double seconds = kEngineStepsPerControlStep * model().opt.timestep;
  const double velocity = (data().qpos[0] - x_before) / seconds;
  double cost = 0;
  for (const double torque : action) cost += kControlCost * torque * torque;
  const bool healthy = Healthy();
  const double bonus = healthy || variant_.always_healthy_reward ? kHealthyReward : 0;
  return {.reward = velocity + bonus - cost, .terminated = !healthy};
}

bool Hopper::Healthy() const {
  const auto inside = [](double value) { return std::fabs(value) < kLargestHealthyState; };
  const double* qpos = data().qpos;
  return std::all_of(qpos + 2, qpos + kJoints, inside) &&
         std::all_of(data().qvel, data().qvel + kJoints, inside) && qpos[1] > kLowestHealthyZ &&
         std::fabs(qpos[2]) < kLargestHealthyPitch;
}

void Hopper::Observe(std::span<double> observation, std::span<double>, std::span<double>) const {
  CHECK(observation.size() == 2 * kJoints - 1) << observation.size();
  auto out = std::copy(data().qpos + 1, data().qpos + kJoints, observation.begin());
  std::transform(data().qvel, data().qvel + kJoints, out, [&](double velocity) {
    if (!variant_.clip_velocities) return velocity;
    return std::clamp(velocity, -kLargestVelocityShown, kLargestVelocityShown);
  });
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_arm.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "actor/worlds/site_motion.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

constexpr double kMetresPerAction = 0.05;
// The gripper points down. The engine normalises the quaternion.
constexpr double kDownQuaternion[4] = {1, 0, 1, 0};
constexpr double kStartOffset[3] = {-0.498, 0.005, -0.431};  // mocap body relative to the grip site
constexpr int kSetupEnvSteps = 10;
constexpr int kMostStepsToGoal = 20;  // env steps of MoveTo
constexpr double kNearGoal = 1e-3;    // m
constexpr double kPull = 0.7;         // share of the remaining error that each of these steps adds

}  // namespace

FetchArm::FetchArm(World* world, const FetchArmSetup& setup, Physics physics)
    : world_(world), setup_(setup) {
  const mjModel& model = world->model();
  grip_site_ = world->SiteId("robot0:grip");
  gripper_body_ = world->BodyId("robot0:gripper_link");
  const int mocap_body = world->BodyId("robot0:mocap");
  mocap_ = model.body_mocapid[mocap_body];
  if (mocap_ < 0) {
    throw RuntimeError("{}: body 'robot0:mocap' is not a mocap body", world->source());
  }
  const char* const fingers[] = {"robot0:r_gripper_finger_joint", "robot0:l_gripper_finger_joint"};
  for (size_t i = 0; i < 2; ++i) {
    const int joint = world->JointId(fingers[i]);
    finger_position_[i] = model.jnt_qposadr[joint];
    finger_velocity_[i] = model.jnt_dofadr[joint];
  }
  const char* const slides[] = {"robot0:slide0", "robot0:slide1", "robot0:slide2"};
  for (size_t i = 0; i < 3; ++i) {
    base_position_[i] = model.jnt_qposadr[world->JointId(slides[i])];
  }
  FindMotors();
  PrepareWeld(world, mocap_body, gripper_body_, physics);
}

// Takes every actuator for a finger's position servo.
void FetchArm::FindMotors() {
  const mjModel& model = world_->model();
  for (int i = 0; i < model.nu; ++i) {
    const int joint = model.actuator_trnid[2 * i];
    if (model.actuator_trntype[i] != mjTRN_JOINT || model.jnt_type[joint] == mjJNT_FREE ||
        model.jnt_type[joint] == mjJNT_BALL) {
      throw RuntimeError("{}: actuator {} does not drive a slide or hinge joint", world_->source(),
                         i);
    }
    motor_position_.push_back(model.jnt_qposadr[joint]);
  }
  if (setup_.block_gripper) return;
  for (const int finger : finger_position_) {
    if (std::find(motor_position_.begin(), motor_position_.end(), finger) ==
        motor_position_.end()) {
      throw RuntimeError("{} has no actuator for both of the gripper's finger joints",
                         world_->source());
    }
  }
}

void FetchArm::SetUp() {
  mjModel& model = world_->model();
  mjData& data = world_->data();
  for (size_t i = 0; i < 3; ++i) data.qpos[base_position_[i]] = setup_.base[i];
  // Twice, because each call moves the solver's warm start a little.
  mj_forward(&model, &data);
  mj_forward(&model, &data);

  const double* grip = data.site_xpos + 3 * grip_site_;
  for (int i = 0; i < 3; ++i) data.mocap_pos[3 * mocap_ + i] = grip[i] + kStartOffset[i];
  data.mocap_pos[3 * mocap_ + 2] += setup_.gripper_extra_height;
  std::copy_n(kDownQuaternion, 4, data.mocap_quat + 4 * mocap_);
  for (int i = 0; i < kSetupEnvSteps * kEngineStepsPerEnvStep; ++i) mj_step(&model, &data);

  std::copy_n(data.site_xpos + 3 * grip_site_, 3, initial_grip_.begin());
  initial_time_ = data.time;
  initial_qpos_.assign(data.qpos, data.qpos + model.nq);
  initial_qvel_.assign(data.qvel, data.qvel + model.nv);
}

void FetchArm::RestoreInitialState() {
  mjData& data = world_->data();
  CHECK(!initial_qpos_.empty()) << "reset before set-up";
  mj_resetData(&world_->model(), &data);
  data.time = initial_time_;
  std::copy(initial_qpos_.begin(), initial_qpos_.end(), data.qpos);
  std::copy(initial_qvel_.begin(), initial_qvel_.end(), data.qvel);
}

void FetchArm::Act(std::span<const double> action) {
  CHECK(action.size() == 4) << action.size();
  const mjModel& model = world_->model();
  mjData& data = world_->data();
  // Finger motors exist only in tasks that grasp, one per finger joint.
  const double fingers = setup_.block_gripper ? 0 : action[3];
  for (int i = 0; i < model.nu; ++i) {
    data.ctrl[i] = data.qpos[motor_position_[static_cast<size_t>(i)]] + fingers;
  }
  double* position = data.mocap_pos + 3 * mocap_;
  double* quaternion = data.mocap_quat + 4 * mocap_;
  const double* gripper_position = data.xpos + 3 * gripper_body_;
  const double* gripper_quaternion = data.xquat + 4 * gripper_body_;
  for (int i = 0; i < 3; ++i) {
    position[i] = gripper_position[i] + kMetresPerAction * action[static_cast<size_t>(i)];
  }
  for (int i = 0; i < 4; ++i) quaternion[i] = gripper_quaternion[i] + kDownQuaternion[i];
}

void FetchArm::FinishStep() {
  if (!setup_.block_gripper) return;
  for (const int finger : finger_position_) world_->data().qpos[finger] = 0;
  mj_forward(&world_->model(), &world_->data());
}

void FetchArm::MoveTo(const std::array<double, 3>& position, double opening) {
  mjModel& model = world_->model();
  mjData& data = world_->data();
  const double* gripper = data.xpos + 3 * gripper_body_;
  std::copy_n(gripper, 3, data.mocap_pos + 3 * mocap_);
  for (int step = 0; step < kMostStepsToGoal; ++step) {
    const std::array<double, 3> grip = GripPosition();
    double squared = 0;
    for (size_t i = 0; i < 3; ++i) {
      const double away = position[i] - grip[i];
      // The weld yields when the arm is stretched, so the remaining error is accumulated.
      data.mocap_pos[3 * static_cast<size_t>(mocap_) + i] += kPull * away;
      squared += away * away;
    }
    if (squared < kNearGoal * kNearGoal) break;
    std::copy_n(kDownQuaternion, 4, data.mocap_quat + 4 * mocap_);
    for (int i = 0; i < kEngineStepsPerEnvStep; ++i) mj_step(&model, &data);
    mj_kinematics(&model, &data);
  }
  for (const int finger : finger_position_) data.qpos[finger] = opening;
  std::fill_n(data.qvel, model.nv, 0.0);
  mj_forward(&model, &data);
}

std::array<double, 3> FetchArm::GripPosition() const { return PositionOfSite(*world_, grip_site_); }

double FetchArm::StepSeconds() const {
  return world_->model().opt.timestep * kEngineStepsPerEnvStep;
}

std::array<double, 3> FetchArm::GripVelocity() const {
  std::array<double, 3> velocity = VelocityOfSite(*world_, grip_site_).linear;
  for (double& component : velocity) component *= StepSeconds();
  return velocity;
}

std::array<double, 2> FetchArm::Fingers() const {
  const mjData& data = world_->data();
  return {data.qpos[finger_position_[0]], data.qpos[finger_position_[1]]};
}

std::array<double, 2> FetchArm::FingerVelocities() const {
  const mjData& data = world_->data();
  return {data.qvel[finger_velocity_[0]] * StepSeconds(),
          data.qvel[finger_velocity_[1]] * StepSeconds()};
}

}  // namespace shoal::worlds

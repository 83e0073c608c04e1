// SPDX-License-Identifier: Apache-2.0
// Base of the physics halves of all Fetch tasks: the arm, the goal and its marker, the order of
// engine calls in reset and step.
//
// Follows Gymnasium-Robotics' Fetch environments, v4. A user's model must have the same named
// elements as the built-in models: bodies robot0:mocap (mocap) and robot0:gripper_link, welded in
// this order; sites robot0:grip and target0; joints robot0:slide0 to 2,
// robot0:r_gripper_finger_joint and robot0:l_gripper_finger_joint; with an object also the free
// joint object0:joint and the site object0. The error names each missing element.
#pragma once

#include <array>
#include <string>

#include "actor/worlds/fetch_arm.h"
#include "actor/worlds/world.h"
#include "actor/worlds/world_options.h"

namespace shoal::worlds {

class FetchWorld : public World {
 public:
  // Starts an episode with this goal and, in tasks with an object, with the object at `object_xy`
  // (m, world frame). The object has the height and rotation that the set-up gave it.
  void ResetTo(const std::array<double, 3>& goal, const std::array<double, 2>& object_xy = {});

  Outcome Step(std::span<const double> action) final;
  bool HideGoal() final;
  bool CanMoveToGoal() const final { return true; }
  std::span<const CameraView> cameras() const final { return cameras_; }

  const FetchArm& arm() const { return arm_; }
  // Site of the object; -1 in tasks without an object.
  virtual int object_site() const { return -1; }

 protected:
  // `model_name`: the embedded model, which is loaded unless the options name a user's model.
  // `cameras` outlive the world.
  FetchWorld(const std::string& model_name, const WorldOptions& options, const FetchArmSetup& setup,
             std::span<const CameraView> cameras);

  // Places the object. ResetTo calls PlaceObject after it has restored the initial state.
  virtual void PlaceObject(const std::array<double, 2>& /*xy*/) {}

  // See FetchArm::SetUp. Call once, at the end of the constructor, after the object is placed.
  void SetUpArm() { arm_.SetUp(); }
  FetchArm& moving_arm() { return arm_; }
  const std::array<double, 3>& goal() const { return goal_; }

 private:
  FetchArm arm_;
  std::span<const CameraView> cameras_;
  int target_site_;
  std::array<double, 3> goal_{};
};

}  // namespace shoal::worlds

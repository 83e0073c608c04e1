// SPDX-License-Identifier: Apache-2.0
// Physics half of FetchPush, FetchSlide and FetchPickAndPlace: bring an object to a goal. The three
// tasks differ only in model and numbers.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "actor/worlds/fetch_world.h"

namespace shoal::worlds {

// Position of the gripper in the picture of a goal. The object is at rest at the goal, not rotated.
enum class GripperAtGoal {
  kAbove,   // 10 cm above the object, fingers shut, no contact; visible to a wrist camera
  kAround,  // grip site in the middle of the object, fingers at the object's sides
  kStart,   // start position of episodes, for tasks whose goals the arm cannot reach
};

struct FetchObjectSetup {
  const char* model;  // "fetch_push.xml"
  std::span<const CameraView> (*cameras)();
  const CameraView& (*film_camera)();
  FetchArmSetup arm;
  std::array<double, 3> object{};  // position before the set-up's engine steps, m; not rotated
  double object_range = 0;         // largest offset of the object from the grip, each axis, m
  double goal_range = 0;           // largest offset of the goal from the grip, each axis, m
  double goal_offset_x = 0;        // added to the goal's x, m
  bool goal_in_the_air = false;    // half of the goals are in the air above the table
  GripperAtGoal gripper_at_goal = GripperAtGoal::kAbove;
};

class FetchObjectWorld final : public FetchWorld {
 public:
  // Throws Error if the model does not load or lacks an element.
  FetchObjectWorld(const FetchObjectSetup& setup, const WorldOptions& options);

  // Draws in this order: the object's x and y, repeated until the object is 10 cm or more from the
  // grip; three numbers x, y, z for the goal (z is not used); if goals may be in the air, a uniform
  // number, and if this number is below 1/2, the goal's height above the table.
  void Reset(Random* random) override;
  // observation (25): see the goal half.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

  const CameraView* film_camera() const override { return &setup_.film_camera(); }
  int object_site() const override { return object_site_; }
  // z in m of the object's site after the set-up's engine steps, and of goals on the table.
  double table_height() const { return table_height_; }

 private:
  void PlaceObject(const std::array<double, 2>& xy) override;
  // Moves the object to the goal and the gripper to the set-up's gripper_at_goal.
  void MoveToGoal() override;
  // Places the object at `position` (m), not rotated, with zero velocity.
  void SetObject(const std::array<double, 3>& position);

  FetchObjectSetup setup_;
  int object_site_;
  int object_position_;  // index in qpos
  int object_velocity_;  // index in qvel
  double table_height_ = 0;
};

std::unique_ptr<World> MakeFetchPush(const WorldOptions& options);
std::unique_ptr<World> MakeFetchSlide(const WorldOptions& options);
std::unique_ptr<World> MakeFetchPickAndPlace(const WorldOptions& options);

}  // namespace shoal::worlds

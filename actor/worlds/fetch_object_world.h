// SPDX-License-Identifier: Apache-2.0
// Physics half of FetchPush, FetchSlide and FetchPickAndPlace: bring an object to a goal. The three
// differ in model and numbers only.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "actor/worlds/fetch_world.h"

namespace shoal::worlds {

// Position of the gripper in the picture of a goal. The object is at rest at the goal, not rotated.
enum class GripperAtGoal {
  kAbove,   // 10 cm above the object, fingers shut: touches nothing, and a wrist camera sees it
  kAround,  // the grip site in the object's middle, the fingers at its sides
  kStart,   // where episodes start: the arm cannot reach the goals
};

struct FetchObjectSetup {
  const char* model;  // "fetch_push.xml"
  std::span<const CameraView> (*cameras)();
  const CameraView& (*film_camera)();
  FetchArmSetup arm;
  std::array<double, 3> object{};  // position before the set-up's engine steps, m; unturned
  double object_range = 0;         // of the object around the grip, each axis, m
  double goal_range = 0;           // likewise of the goal
  double goal_offset_x = 0;        // added to the goal, m
  bool goal_in_the_air = false;    // half of the goals
  GripperAtGoal gripper_at_goal = GripperAtGoal::kAbove;
};

class FetchObjectWorld final : public FetchWorld {
 public:
  // Throws Error when the model does not load or lacks an element.
  FetchObjectWorld(const FetchObjectSetup& setup, const WorldOptions& options);

  // Draws, in this order: the object's x and y, again and again until it is 10 cm or more from the
  // grip; three numbers x, y, z for the goal, of which z is not used; where goals may be in the
  // air a coin, and when it is below 1/2 the height above the table.
  void Reset(Random* random) override;
  // observation (25): see the goal half.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

  const CameraView* film_camera() const override { return &setup_.film_camera(); }
  int object_site() const override { return object_site_; }
  // z in m of the object's site as the last of the set-up's engine steps left it: that of a goal on
  // the table.
  double table_height() const { return table_height_; }

 private:
  void PlaceObject(const std::array<double, 2>& xy) override;
  // The object at the goal, the gripper as the set-up says.
  void MoveToGoal() override;
  // The object's position, m, unturned; takes its velocity away.
  void SetObject(const std::array<double, 3>& position);

  FetchObjectSetup setup_;
  int object_site_;
  int object_position_;  // in qpos
  int object_velocity_;  // in qvel
  double table_height_ = 0;
};

std::unique_ptr<World> MakeFetchPush(const WorldOptions& options);
std::unique_ptr<World> MakeFetchSlide(const WorldOptions& options);
std::unique_ptr<World> MakeFetchPickAndPlace(const WorldOptions& options);

}  // namespace shoal::worlds

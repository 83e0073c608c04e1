// Physics half of FetchPush, FetchSlide and FetchPickAndPlace: bring an object to a goal. The three
// differ in model and numbers only.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "actor/worlds/fetch_world.h"

namespace shoal::worlds {

struct FetchObjectSetup {
  const char* model;  // "fetch_push.xml"
  std::span<const CameraView> (*cameras)();
  FetchArmSetup arm;
  std::array<double, 3> object{};  // position before the set-up's engine steps, m; unturned
  double object_range = 0;         // of the object around the grip, each axis, m
  double goal_range = 0;           // likewise of the goal
  double goal_offset_x = 0;        // added to the goal, m
  bool goal_in_the_air = false;    // half of the goals
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

  int object_site() const override { return object_site_; }
  // z in m of the object's site as the last of the set-up's engine steps left it: that of a goal on
  // the table.
  double table_height() const { return table_height_; }

 private:
  void PlaceObject(const std::array<double, 2>& xy) override;

  FetchObjectSetup setup_;
  int object_site_;
  int object_position_;  // in qpos
  double table_height_ = 0;
};

std::unique_ptr<World> MakeFetchPush(const WorldOptions& options);
std::unique_ptr<World> MakeFetchSlide(const WorldOptions& options);
std::unique_ptr<World> MakeFetchPickAndPlace(const WorldOptions& options);

}  // namespace shoal::worlds

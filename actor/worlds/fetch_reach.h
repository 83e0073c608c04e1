// Physics half of FetchReach: bring the grip site to a goal above the table.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "actor/worlds/fetch_arm.h"
#include "actor/worlds/world.h"

namespace shoal::worlds {

class FetchReach final : public World {
 public:
  // `model_file` empty = our own model. Throws Error when it does not load or lacks an element.
  explicit FetchReach(const std::string& model_file);

  // Draws the goal: three uniform numbers, x, y, z in this order, within 15 cm of the grip's
  // initial position along each axis.
  void Reset(Random* random) override;
  // Starts an episode with this goal (m, world frame).
  void ResetTo(const std::array<double, 3>& goal);

  Outcome Step(std::span<const double> action) override;
  // observation (10): grip position, fingers, grip velocity, finger velocities; see the goal half.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;
  std::span<const CameraView> cameras() const override;

  const FetchArm& arm() const { return arm_; }

 private:
  FetchArm arm_;
  int target_site_;
  std::array<double, 3> goal_{};
};

std::unique_ptr<World> MakeFetchReach(const std::string& model_file);

}  // namespace shoal::worlds

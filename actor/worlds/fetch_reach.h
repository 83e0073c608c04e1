// SPDX-License-Identifier: Apache-2.0
// Physics half of FetchReach: bring the grip site to a goal above the table.
#pragma once

#include <memory>

#include "actor/worlds/fetch_world.h"

namespace shoal::worlds {

class FetchReach final : public FetchWorld {
 public:
  // Throws Error if the model does not load or lacks an element.
  explicit FetchReach(const WorldOptions& options = {});

  // Draws the goal: uniform numbers for x, y and z in this order, each within 15 cm of the grip's
  // initial position.
  void Reset(Random* random) override;
  // observation (10): grip position, fingers, grip velocity, finger velocities; see the goal half.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  // Moves the grip site to the goal, with the fingers shut.
  void MoveToGoal() override;
};

std::unique_ptr<World> MakeFetchReach(const WorldOptions& options);

}  // namespace shoal::worlds

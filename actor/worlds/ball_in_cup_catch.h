// SPDX-License-Identifier: Apache-2.0
// Physics half of ball_in_cup_catch: swing a ball on a string into the cup.
//
//   reward = 1 while the ball is inside the cup's target box, else 0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "actor/worlds/control_world.h"

namespace shoal::worlds {

class BallInCupCatch final : public ControlWorld {
 public:
  // `model_file`: empty = the built-in model. Throws Error if the model does not load or lacks an
  // element.
  explicit BallInCupCatch(const std::string& model_file);

  // The goal half documents the order of the numbers. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  void Draw(Random* random) override;
  double Reward() const override;

  int ball_joint_, ball_, ball_geom_, target_;  // in this order: coordinate, body, geom, site
};

std::unique_ptr<World> MakeBallInCupCatch(const std::string& model_file);

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Physics half of reacher_easy: bring the fingertip to a target in the plane.
//
//   reward = 1 while finger and target overlap, else 0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>

#include "actor/worlds/control_world.h"

namespace shoal::worlds {

class ReacherEasy final : public ControlWorld {
 public:
  // `model_file`: empty = the built-in model. Throws Error if the model does not load or lacks an
  // element.
  explicit ReacherEasy(const std::string& model_file);

  // Sets the target's centre (m) for the next ResetTo. Reset draws a new centre.
  void PlaceTarget(const std::array<double, 2>& position);
  // The goal half documents the order of the numbers. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  void Draw(Random* random) override;
  double Reward() const override;
  // Vector from the finger to the target, m.
  std::array<double, 2> ToTarget() const;

  int finger_, target_;  // geoms
};

std::unique_ptr<World> MakeReacherEasy(const std::string& model_file);

}  // namespace shoal::worlds

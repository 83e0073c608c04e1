// SPDX-License-Identifier: Apache-2.0
// Physics half of cartpole_swingup: swing the pole up from hanging and balance it near the middle.
//
//   reward = upright * small_control * small_velocity * centered, each in [0, 1]
#pragma once

#include <memory>
#include <span>
#include <string>

#include "actor/worlds/control_world.h"

namespace shoal::worlds {

class CartpoleSwingup final : public ControlWorld {
 public:
  // `model_file`: empty = the built-in model. Throws Error if the model does not load or lacks an
  // element.
  explicit CartpoleSwingup(const std::string& model_file);

  // The goal half documents the order of the numbers. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  void Draw(Random* random) override;
  double Reward() const override;

  int pole_;
};

std::unique_ptr<World> MakeCartpoleSwingup(const std::string& model_file);

}  // namespace shoal::worlds

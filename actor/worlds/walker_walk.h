// SPDX-License-Identifier: Apache-2.0
// Physics half of walker_walk: walk forward upright.
//
//   reward = (3 standing + upright) / 4 * (5 move + 1) / 6, each in [0, 1]
#pragma once

#include <memory>
#include <span>
#include <string>

#include "actor/worlds/control_world.h"

namespace shoal::worlds {

class WalkerWalk final : public ControlWorld {
 public:
  // `model_file`: empty = the built-in model. Throws Error if the model does not load or lacks an
  // element.
  explicit WalkerWalk(const std::string& model_file);

  // The goal half documents the order of the numbers. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  void Draw(Random* random) override;
  double Reward() const override;

  int torso_;     // body; the bodies of the limbs have the next numbers
  int velocity_;  // index in sensordata of the velocity of the whole body's centre of mass
};

std::unique_ptr<World> MakeWalkerWalk(const std::string& model_file);

}  // namespace shoal::worlds

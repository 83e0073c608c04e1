// SPDX-License-Identifier: Apache-2.0
// Physics half of cheetah_run: run forward.
//
//   reward = forward speed of the whole body's centre of mass (sensor `torso_velocity`)
//            / (10 m/s), at least 0, at most 1
#pragma once

#include <memory>
#include <span>
#include <string>

#include "actor/worlds/control_world.h"

namespace shoal::worlds {

class CheetahRun final : public ControlWorld {
 public:
  // `model_file`: empty = the built-in model. Throws Error if the model does not load or lacks an
  // element.
  explicit CheetahRun(const std::string& model_file);

  // The goal half documents the order of the numbers. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  void Draw(Random* random) override;
  // Simulates two seconds without control. The resulting state is the start of the episode.
  void Settle() override;
  double Reward() const override;

  int velocity_;  // index in sensordata of that velocity
};

std::unique_ptr<World> MakeCheetahRun(const std::string& model_file);

}  // namespace shoal::worlds

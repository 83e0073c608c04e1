// SPDX-License-Identifier: Apache-2.0
// Physics half of finger_spin: keep a hinged body spinning by flicking it.
//
//   reward = 1 while the spinner turns at 15 rad/s or faster, in the negative sense, else 0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "actor/worlds/control_world.h"

namespace shoal::worlds {

class FingerSpin final : public ControlWorld {
 public:
  // `model_file`: empty = the built-in model. Throws Error if the model does not load or lacks an
  // element.
  explicit FingerSpin(const std::string& model_file);

  // The goal half documents the order of the numbers. The task has no goals.
  void Observe(std::span<double> observation, std::span<double> achieved_goal,
               std::span<double> desired_goal) const override;

 private:
  void Draw(Random* random) override;
  double Reward() const override;

  int spinner_, tip_;             // spinner: a body; tip: a site
  int touch_top_, touch_bottom_;  // indices in sensordata
};

std::unique_ptr<World> MakeFingerSpin(const std::string& model_file);

}  // namespace shoal::worlds

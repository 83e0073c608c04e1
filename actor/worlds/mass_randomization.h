// SPDX-License-Identifier: Apache-2.0
// Uniform domain randomization: masses of bodies drawn anew for each episode.
//
//   mass_b ~ Uniform[low_b, high_b], body by body in alphabetical order
//
// Only the mass is changed, in the world's own copy of the model, as in other environments with
// randomized masses. Inertias and quantities that the compiler derived (inverse weights, subtree
// masses) do not change.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/environment.h"
#include "actor/worlds/world.h"
#include "common/base/random.h"

namespace shoal::worlds {

class MassRandomization {
 public:
  // `intervals`: body -> [low, high] in kg, 0 < low <= high. Throws Error (kUsage) naming a body
  // that the model does not have, and the model's bodies.
  MassRandomization(const World& world,
                    const std::map<std::string, std::array<double, 2>>& intervals);

  // Draws one number per body and writes it into the model of `world`. Call it before the world's
  // reset. One thread.
  void Draw(Random* random, World* world);
  // Masses of the last Draw, in drawing order.
  std::span<const DrawnMass> drawn() const { return drawn_; }

 private:
  struct Interval {
    int body;
    double low, high;  // kg
  };

  std::vector<Interval> intervals_;
  std::vector<DrawnMass> drawn_;
};

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Uniform domain randomization: masses of bodies drawn anew for each episode.
//
//   mass_b ~ Uniform[low_b, high_b], body by body in alphabetical order
//
// Only the mass itself is written, as in other environments with randomized masses, into the
// world's own copy of the model. Inertias and what the compiler derived from them (inverse weights,
// subtree masses) are unchanged.
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
  // intervals: body -> [low, high] in kg, 0 < low <= high. Throws Error (kUsage) naming a body that
  // the model does not have, and those it has.
  MassRandomization(const World& world,
                    const std::map<std::string, std::array<double, 2>>& intervals);

  // Draws one number per body and writes it into the model of `world`. Call it before the world's
  // reset. One thread.
  void Draw(Random* random, World* world);
  // In the order drawn; masses of the last Draw.
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

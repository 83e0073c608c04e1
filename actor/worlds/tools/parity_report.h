// SPDX-License-Identifier: Apache-2.0
// How far our physics is from a measurement: what a replay found, for people and programs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace shoal::worlds {

// Largest absolute difference of one quantity over the reset and all steps, over all its
// components.
struct Deviation {
  std::string quantity;  // "grip_position"
  std::string unit;      // of the difference: "m"; empty = dimensionless or mixed
  double largest = 0;
  int at_step = 0;       // env step where it occurs, 0 = reset
  double tolerance = 0;  // what it may be; 0 = for information, not judged

  bool Passed() const { return tolerance == 0 || largest <= tolerance; }
};

struct ReplayReport {
  std::string file, environment, sequence;
  std::string physics;  // "mujoco2", "mujoco3"
  std::string model;    // the user's file, empty = ours
  int steps = 0;
  double tolerance = 0;  // of this sequence; m where there is a goal
  std::vector<Deviation> deviations;
  // Steps where the sparse reward or the success flag differ although the reference's distance is
  // further from the threshold than the tolerance.
  int reward_mismatches = 0, success_mismatches = 0;
  int contact_mismatches = 0;      // reset and steps with another number of contacts; not judged
  int termination_mismatches = 0;  // steps that terminate in one and not in the other
  // First env step whose object is not judged any more, nor what follows from it (Slide, from the
  // puck's first hit on); 0 = judged to the end.
  int chaotic_from = 0;
  bool passed = false;

  // Notes the difference of two vectors of one size at an env step.
  void Compare(const std::string& quantity, const std::string& unit, double judged_by,
               std::span<const double> ours, std::span<const double> theirs, int step);
  // Sets `passed` from everything else.
  void Judge();
};

// Schema shoal-parity-1.
nlohmann::ordered_json ToJson(const ReplayReport& report);
// For people: a line per quantity, the verdict last.
std::string ToText(const ReplayReport& report);

}  // namespace shoal::worlds

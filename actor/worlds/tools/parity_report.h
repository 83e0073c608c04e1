// SPDX-License-Identifier: Apache-2.0
// Report on the deviation of Shoal's physics from a measurement, for people and programs.
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
  int at_step = 0;       // env step of the largest difference, 0 = reset
  double tolerance = 0;  // largest allowed value; 0 = any value passes

  bool Passed() const { return tolerance == 0 || largest <= tolerance; }
};

struct ReplayReport {
  std::string file, environment, sequence;
  std::string physics;  // "mujoco2", "mujoco3"
  std::string model;    // the user's file; empty = the built-in model
  int steps = 0;
  double tolerance = 0;  // of this sequence; in m for tasks with a goal
  std::vector<Deviation> deviations;
  // Steps with a different sparse reward or success flag although the reference's distance differs
  // from the threshold by more than the tolerance.
  int reward_mismatches = 0, success_mismatches = 0;
  int contact_mismatches = 0;      // reset and steps with another number of contacts; not judged
  int termination_mismatches = 0;  // steps that terminate only in Shoal or only in the reference
  // Env step of the first hit on Slide's puck. From this step on, the object, and quantities that
  // depend on the object, are not judged. 0 = all steps are judged.
  int chaotic_from = 0;
  bool passed = false;

  // Adds the difference of two vectors of the same size at an env step.
  void Compare(const std::string& quantity, const std::string& unit, double judged_by,
               std::span<const double> ours, std::span<const double> theirs, int step);
  // Sets `passed` from the other members.
  void Judge();
};

// Schema shoal-parity-1.
nlohmann::ordered_json ToJson(const ReplayReport& report);
// The report as text: one line per quantity, then the verdict.
std::string ToText(const ReplayReport& report);

}  // namespace shoal::worlds

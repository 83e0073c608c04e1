// Parity with the original environments: replays a recorded trajectory's goal and actions in our
// physics and says how far apart the two get.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
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
  int steps = 0;
  double tolerance = 0;  // m, of this sequence
  std::vector<Deviation> deviations;
  // Steps where the sparse reward or the success flag differ although the reference's distance is
  // further from the threshold than the tolerance.
  int reward_mismatches = 0, success_mismatches = 0;
  bool passed = false;
};

// Tolerances: 1e-5 m; 1e-3 m for const_z_close and 1e-2 m for const_y, where the arm folds onto
// itself and hulls of stand-in shapes meet. Positions, distances and dense rewards are judged,
// velocities and joint coordinates reported. Throws Error on a file that cannot be read or
// replayed; see ReadReference.
ReplayReport ReplayReference(const std::filesystem::path& path);

// Schema shoal-parity-1.
nlohmann::ordered_json ToJson(const ReplayReport& report);
// For people: a line per quantity, the verdict last.
std::string ToText(const ReplayReport& report);

}  // namespace shoal::worlds

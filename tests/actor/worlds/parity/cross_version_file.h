// SPDX-License-Identifier: Apache-2.0
// Grip positions of the original Fetch models in newer versions of MuJoCo: format vrl-xversion-1.
//
// The file contains no actions and no initial states. The actions of the sequences const_* and zero
// follow from their names. The actions of other sequences, and the positions of object and goal,
// are read from the trajectories of the same task in the same folder (format vrl-ref-1,
// "fetch_Push_random0.json").
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::worlds {

constexpr const char* kCrossVersionFormat = "vrl-xversion-1";

struct CrossVersionSequence {
  std::string task;      // "FetchPush"
  std::string sequence;  // "const_x"
  std::string version;   // of MuJoCo: "3.3.8"
  std::array<double, 3> initial_grip{};
  std::vector<std::array<double, 3>> grip;  // m, after each env step

  // These members are not in the file; ReadCrossVersions finds their values.
  std::array<double, 2> object_xy{};
  std::array<double, 3> desired_goal{};
  std::vector<std::array<double, 4>> actions{};
};

struct CrossVersionFile {
  std::vector<CrossVersionSequence> sequences;
  std::vector<std::string> left_out;  // "FetchPush random1": no trajectory has its actions
};

// Reads the sequences of one version of MuJoCo. Throws Error naming the file and the key if the
// file is not JSON or has another format, if the version or a key is missing, if a key has a wrong
// type, or if a task has no trajectory in the folder of the file.
CrossVersionFile ReadCrossVersions(const std::filesystem::path& path, const std::string& version);

}  // namespace shoal::worlds

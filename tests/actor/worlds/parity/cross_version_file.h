// SPDX-License-Identifier: Apache-2.0
// Grip positions of the original Fetch models in newer versions of MuJoCo: format vrl-xversion-1.
//
// The file holds no actions and no starts. Those of the sequences const_* and zero follow from
// their names; the others', and where the object lies and the goal is, come from the trajectories
// of the same task (format vrl-ref-1, "fetch_Push_random0.json") in the same folder.
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

  // Found by ReadCrossVersions.
  std::array<double, 2> object_xy{};
  std::array<double, 3> desired_goal{};
  std::vector<std::array<double, 4>> actions{};
};

struct CrossVersionFile {
  std::vector<CrossVersionSequence> sequences;
  std::vector<std::string> left_out;  // "FetchPush random1": no trajectory tells their actions
};

// The sequences of one version of MuJoCo. Throws Error naming the file and the key: not JSON,
// another format, no such version, a key missing or ill-typed, a task without any trajectory beside
// the file.
CrossVersionFile ReadCrossVersions(const std::filesystem::path& path, const std::string& version);

}  // namespace shoal::worlds

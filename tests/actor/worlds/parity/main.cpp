// SPDX-License-Identifier: Apache-2.0
// shoal-parity FILE...: replays recorded trajectories of the original environments in Shoal's
// physics and reports the largest differences. Exit code 1 if a difference exceeds the tolerance.
#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/base/command_line.h"
#include "common/base/main_guard.h"
#include "tests/actor/worlds/parity/replay_file.h"

namespace {

using shoal::worlds::ReplayOptions;
using shoal::worlds::ReplayReport;

int ReplayFiles(const std::vector<std::string>& files, const ReplayOptions& options, bool json) {
  bool passed = true;
  nlohmann::ordered_json reports = nlohmann::ordered_json::array();
  for (const std::string& file : files) {
    for (const ReplayReport& report : shoal::worlds::ReplayFile(file, options)) {
      passed = passed && report.passed;
      if (json) {
        reports.push_back(shoal::worlds::ToJson(report));
      } else {
        std::cout << shoal::worlds::ToText(report) << std::endl;
      }
    }
  }
  // One report is given itself, several as a list.
  if (json) std::cout << (reports.size() == 1 ? reports[0] : reports).dump(2) << std::endl;
  return passed ? 0 : 1;
}

int Run(int argc, char** argv) {
  CLI::App app("Replays recorded trajectories of the original environments in our physics.",
               "shoal-parity");
  std::vector<std::string> files;
  ReplayOptions options;
  bool json = false;
  app.add_option("files", files,
                 "Trajectories (JSON, format vrl-ref-1), or grip positions in newer versions of "
                 "MuJoCo (vrl-xversion-1) beside trajectories of the same actions")
      ->required();
  app.add_option("--model", options.model, "Another MJCF file for the task");
  app.add_option("--physics", options.physics,
                 "mujoco2 | mujoco3; the default is what the file was made with");
  app.add_flag("--json", json, "Print JSON (schema shoal-parity-1; a list for many reports)");
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  return ReplayFiles(files, options, json);
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-parity", [&] { return Run(argc, argv); });
}

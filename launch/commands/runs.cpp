// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "launch/commands/commands.h"
#include "launch/watch/run_list.h"

namespace shoal::launch {
namespace {

int Runs(const std::string& dir, bool json) {
  const std::vector<RunListing> runs = ListRunStatus(dir);
  if (json) {
    std::printf("%s\n", RunListJson(dir, runs).c_str());
  } else if (runs.empty()) {
    std::printf("no runs in '%s'\n", dir.c_str());
  } else {
    for (const std::string& line : FormatRunList(runs)) std::printf("%s\n", line.c_str());
  }
  return 0;
}

}  // namespace

void AddRunsCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand("runs", "List every run with its state and progress.");
  const auto dir = std::make_shared<std::string>("runs");
  const auto json = std::make_shared<bool>(false);
  command->add_option("--run-dir", *dir, "Folder that holds the runs")->capture_default_str();
  command->add_flag("--json", *json, "Print JSON (schema shoal-runs-1)");
  command->callback([=] { *chosen = [=] { return Runs(*dir, *json); }; });
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/tool_commands.h"

#include <CLI/CLI.hpp>

#include "launch/tools/commands/commands.h"

namespace shoal::launch {

void AddToolCommands(CLI::App& app, Action* chosen) {
  AddExperimentCommand(app, chosen);
  AddCompareCommand(app, chosen);
  AddPlotCommand(app, chosen);
  AddReportCommand(app, chosen);
  AddCardCommand(app, chosen);
  AddExportCommand(app, chosen);
  AddFilmCommand(app, chosen);
  AddWebCommand(app, chosen);
  AddNewCommand(app, chosen);
  AddObservabilityCommand(*app.get_subcommand("env"), chosen);
  AddReplayExportCommand(*app.get_subcommand("replay"), chosen);
}

void CheckToolsAreBuilt(const std::vector<std::string>& /*words*/) {}

}  // namespace shoal::launch

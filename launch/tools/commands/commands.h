// SPDX-License-Identifier: Apache-2.0
// The commands of the tools, one file each. launch/commands/commands.h describes how a command is
// added to the program.
#pragma once

#include "launch/commands/commands.h"

namespace shoal::launch {

void AddExperimentCommand(CLI::App& app, Action* chosen);  // experiment run, status, summary
void AddCompareCommand(CLI::App& app, Action* chosen);
void AddPlotCommand(CLI::App& app, Action* chosen);
void AddReportCommand(CLI::App& app, Action* chosen);
void AddCardCommand(CLI::App& app, Action* chosen);
void AddExportCommand(CLI::App& app, Action* chosen);
void AddFilmCommand(CLI::App& app, Action* chosen);
void AddWebCommand(CLI::App& app, Action* chosen);
void AddNewCommand(CLI::App& app, Action* chosen);

// Sub-commands of commands that every build has.
void AddObservabilityCommand(CLI::App& env, Action* chosen);    // env observability
void AddReplayExportCommand(CLI::App& replay, Action* chosen);  // replay export

}  // namespace shoal::launch

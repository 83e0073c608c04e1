// SPDX-License-Identifier: Apache-2.0
// The commands of `shoal`, one file each. A command adds itself to the command line; when it is the
// one given, it stores what to do in `*chosen`, which main runs: its value is the exit code.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace shoal::launch {

using Action = std::function<int()>;

void AddTrainCommand(CLI::App& app, Action* chosen);
void AddEvalCommand(CLI::App& app, Action* chosen);
void AddExperimentCommand(CLI::App& app, Action* chosen);  // experiment run, status, summary
void AddCompareCommand(CLI::App& app, Action* chosen);
void AddPlotCommand(CLI::App& app, Action* chosen);
void AddReportCommand(CLI::App& app, Action* chosen);
void AddCardCommand(CLI::App& app, Action* chosen);
void AddExportCommand(CLI::App& app, Action* chosen);
void AddFilmCommand(CLI::App& app, Action* chosen);
void AddEnvCommand(CLI::App& app, Action* chosen);  // see env.cpp and env_tasks.cpp
void AddTopCommand(CLI::App& app, Action* chosen);
void AddConfigCommand(CLI::App& app, Action* chosen);
void AddNewCommand(CLI::App& app, Action* chosen);
void AddCheckCommand(CLI::App& app, Action* chosen);
void AddSecureCommand(CLI::App& app, Action* chosen);  // secure init
void AddRunsCommand(CLI::App& app, Action* chosen);
void AddCleanCommand(CLI::App& app, Action* chosen);
void AddWebCommand(CLI::App& app, Action* chosen);
void AddSteerCommands(CLI::App& app, Action* chosen);  // set, scale, stop
void AddAttachCommand(CLI::App& app, Action* chosen);
void AddReplayCommand(CLI::App& app, Action* chosen);  // replay peek, export

}  // namespace shoal::launch

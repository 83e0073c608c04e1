// SPDX-License-Identifier: Apache-2.0
// The commands that every build of `shoal` has, one file each. Each function adds a command to the
// command line. If the user gives the command, parsing stores the command's action in `*chosen`.
// main runs the action, which returns the exit code.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace shoal::launch {

using Action = std::function<int()>;

void AddTrainCommand(CLI::App& app, Action* chosen);
void AddEvalCommand(CLI::App& app, Action* chosen);
void AddEnvCommand(CLI::App& app, Action* chosen);  // see env.cpp and env_tasks.cpp
void AddTopCommand(CLI::App& app, Action* chosen);
void AddConfigCommand(CLI::App& app, Action* chosen);
void AddCheckCommand(CLI::App& app, Action* chosen);
void AddSecureCommand(CLI::App& app, Action* chosen);  // secure init
void AddRunsCommand(CLI::App& app, Action* chosen);
void AddCleanCommand(CLI::App& app, Action* chosen);
void AddSteerCommands(CLI::App& app, Action* chosen);  // set, scale, stop
void AddAttachCommand(CLI::App& app, Action* chosen);
void AddReplayCommand(CLI::App& app, Action* chosen);  // replay peek

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/command_line.h"

#include <CLI/CLI.hpp>

#include "common/base/command_line.h"

namespace shoal::launch {

std::unique_ptr<CLI::App> MakeCommandLine(Action* chosen) {
  auto app = std::make_unique<CLI::App>(
      "Shoal trains robot policies from pixels and from state, on many processes.", "shoal");
  AddVersion(app.get());
  app->require_subcommand(1);
  AddTrainCommand(*app, chosen);
  AddEvalCommand(*app, chosen);
  AddExperimentCommand(*app, chosen);
  AddCompareCommand(*app, chosen);
  AddPlotCommand(*app, chosen);
  AddReportCommand(*app, chosen);
  AddCardCommand(*app, chosen);
  AddExportCommand(*app, chosen);
  AddFilmCommand(*app, chosen);
  AddTopCommand(*app, chosen);
  AddRunsCommand(*app, chosen);
  AddCleanCommand(*app, chosen);
  AddWebCommand(*app, chosen);
  AddSteerCommands(*app, chosen);
  AddAttachCommand(*app, chosen);
  AddEnvCommand(*app, chosen);
  AddReplayCommand(*app, chosen);
  AddConfigCommand(*app, chosen);
  AddNewCommand(*app, chosen);
  AddCheckCommand(*app, chosen);
  AddSecureCommand(*app, chosen);
  return app;
}

}  // namespace shoal::launch

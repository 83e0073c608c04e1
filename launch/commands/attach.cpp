// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "common/base/stop.h"
#include "launch/client/attached_run.h"
#include "launch/client/run_connection.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/processes/suspension.h"

namespace shoal::launch {
namespace {

int Attach(const TargetOptions& options) {
  InstallStopSignals();
  SuspendWithChildren();  // this process has no children and stops alone
  RunConnection connection(ResolveTarget(options));
  Progress progress("");
  return ShowAttached(connection.client(), progress);
}

}  // namespace

void AddAttachCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "attach",
      "Show a running run's progress until it ends, with its exit code. Ctrl-C detaches: "
      "the run goes on.");
  const auto options = std::make_shared<TargetOptions>();
  AddTargetOptions(*command, options.get());
  command->callback([=] { *chosen = [=] { return Attach(*options); }; });
}

}  // namespace shoal::launch

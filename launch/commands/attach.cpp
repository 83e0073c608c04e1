// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>
#include <utility>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "launch/commands/commands.h"
#include "launch/commands/target_options.h"
#include "launch/processes/suspension.h"
#include "launch/watch/progress.h"
#include "launch/watch/run_client.h"
#include "launch/watch/run_figures.h"

namespace shoal::launch {
namespace {

constexpr std::chrono::seconds kSilence{15};

// Says the events that have not been said before.
void SayNew(const RunViewMessage& view, uint64_t* said, Progress* progress) {
  for (const RunEvent& event : view.events) {
    if (event.number <= *said) continue;
    progress->Say(event.text);
    *said = event.number;
  }
}

int Attach(const TargetOptions& options) {
  InstallStopSignals();
  SuspendWithChildren();  // which it has none of
  RunClient client(ResolveTarget(options));
  RunViewMessage view = client.FirstView();
  Progress progress("");
  uint64_t said = 0;
  int suspensions = Suspensions();
  while (true) {
    if (std::exchange(suspensions, Suspensions()) != suspensions) progress.Resume();
    SayNew(view, &said, &progress);
    if (view.state == "ended") return ExitCodeOf(view);
    if (view.state != "evaluating") progress.Show(FiguresOfView(view, Now()), Now());
    auto next = client.WaitForView(Now() + kSilence);
    if (StopRequested()) {
      progress.Say("detached; the run goes on");
      return 0;
    }
    if (!next) {
      throw RuntimeError("run '{}': its coordinator has been silent for {} s", view.run,
                         kSilence.count());
    }
    view = *std::move(next);
  }
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

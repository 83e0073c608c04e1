// SPDX-License-Identifier: Apache-2.0
#include "launch/client/attached_run.h"

#include <utility>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "launch/processes/suspension.h"
#include "launch/watch/run_figures.h"

namespace shoal::launch {
namespace {

// Prints events with numbers above `*said`.
void SayNew(const RunViewMessage& view, uint64_t* said, Progress* progress) {
  for (const RunEvent& event : view.events) {
    if (event.number <= *said) continue;
    progress->Say(event.text);
    *said = event.number;
  }
}

}  // namespace

int ShowAttached(RunClient& client, Progress& progress) {
  RunViewMessage view = client.FirstView();
  SameCoordinator coordinator;
  uint64_t said = 0;
  int suspensions = Suspensions();
  while (true) {
    if (std::exchange(suspensions, Suspensions()) != suspensions) progress.Resume();
    if (!coordinator.Take(view)) said = 0;  // a resumed run numbers its events anew
    SayNew(view, &said, &progress);
    if (view.state == "ended") return ExitCodeOf(view);
    if (view.state != "evaluating") progress.Show(FiguresOfView(view, Now()), Now());
    auto next = client.WaitForView(Now() + kAttachedSilence);
    if (StopRequested()) {
      progress.Say("detached; the run goes on");
      return 0;
    }
    if (!next) {
      throw RuntimeError("run '{}': its coordinator has been silent for {} s", view.run,
                         kAttachedSilence.count());
    }
    view = *std::move(next);
  }
}

}  // namespace shoal::launch

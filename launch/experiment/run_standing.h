// How a run of an experiment stands.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "launch/experiment/run_log.h"

namespace shoal::launch {

enum class RunStanding {
  kMissing,      // not begun
  kRunning,      // a coordinator holds it
  kInterrupted,  // stopped, or its processes died: --resume goes on
  kFailed,       // ended by itself and not well
  kFinished,     // target reached or budget spent, and evaluated at the end
};
const char* ToString(RunStanding standing);

struct StandingReport {
  RunStanding standing = RunStanding::kMissing;
  std::string problem{};  // why it failed
};

// From the run's folder and what the experiment's log knows of it (null: nothing). Never throws for
// what is in the folder: a broken file makes it a failed run.
StandingReport StandingOf(const std::filesystem::path& run, const LoggedRun* logged);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// How a run of an experiment stands.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/run_log.h"

namespace shoal::launch {

enum class ExperimentRunStatus {
  kMissing,      // not begun
  kRunning,      // a coordinator holds it
  kInterrupted,  // stopped, or its processes died: --resume goes on
  kFailed,       // ended by itself and not well
  kFinished,     // target reached or budget spent, evaluated at the end and on every further task
};
const char* ToString(ExperimentRunStatus standing);

struct StandingReport {
  ExperimentRunStatus standing = ExperimentRunStatus::kMissing;
  std::string problem{};  // why it failed
  // Further tasks that it is still to be evaluated on; only of a run whose training is done.
  std::vector<std::string> missing_transfers{};
};

// From the run's folder, what the experiment's log knows of it (null: nothing) and the further
// tasks that the experiment evaluates it on: a run is not finished before all of them are done. One
// of the task that it was trained on is left out, unless training drew its masses anew. Never
// throws for what is in the folder: a broken file makes it a failed run.
StandingReport StandingOf(const std::filesystem::path& run, const LoggedRun* logged,
                          const std::vector<std::string>& transfer = {});

// eval/on-TASK.json of a run.
std::filesystem::path TransferFile(const std::filesystem::path& run, const std::string& task);

}  // namespace shoal::launch

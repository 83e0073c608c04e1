// SPDX-License-Identifier: Apache-2.0
// Status of a run of an experiment.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/run_log.h"

namespace shoal::launch {

enum class ExperimentRunStatus {
  kMissing,      // not started
  kRunning,      // a coordinator holds the run
  kInterrupted,  // stopped, or its processes died; --resume continues
  kFailed,       // ended by itself with an error
  kFinished,     // target reached or budget spent; all final evaluations are done
};
const char* ToString(ExperimentRunStatus standing);

struct StandingReport {
  ExperimentRunStatus standing = ExperimentRunStatus::kMissing;
  std::string problem{};  // reason of the failure
  // Further tasks on which the run has no evaluation yet; only for a run whose training is
  // finished.
  std::vector<std::string> missing_transfers{};
};

// Status from the run's folder and from its entries in the experiment's log (null: none).
// `transfer`: further tasks; a run is finished only after it has been evaluated on all of them. The
// training task needs no such evaluation, unless training randomised its masses. Never throws
// because of the folder's content: a broken file gives the status kFailed.
StandingReport StandingOf(const std::filesystem::path& run, const LoggedRun* logged,
                          const std::vector<std::string>& transfer = {});

// eval/on-TASK.json of a run.
std::filesystem::path TransferFile(const std::filesystem::path& run, const std::string& task);

}  // namespace shoal::launch

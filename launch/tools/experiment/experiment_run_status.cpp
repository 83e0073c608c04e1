// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/experiment_run_status.h"

#include <fmt/core.h>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"
#include "launch/tools/experiment/run_results.h"

namespace shoal::launch {
namespace {

// It ended by itself with an error, as opposed to being stopped or killed.
bool EndedBadly(const LoggedRun* logged) {
  return logged != nullptr && logged->ending && !logged->ending->stopped &&
         !logged->ending->by_signal && logged->ending->code != 0 &&
         logged->ending->code != kInterruptedExit;
}

std::vector<std::string> MissingTransfers(const RunResults& results,
                                          const std::vector<std::string>& transfer) {
  std::vector<std::string> missing;
  std::error_code error;
  for (const std::string& task : transfer) {
    const bool same = task == results.config.task && results.config.randomization.body_mass.empty();
    if (!same && !std::filesystem::exists(TransferFile(results.folder, task), error)) {
      missing.push_back(task);
    }
  }
  return missing;
}

StandingReport StandingOfResults(const RunResults& results, const LoggedRun* logged,
                                 const std::vector<std::string>& transfer) {
  if (results.exit == "failed" || !results.error.empty()) {
    return {ExperimentRunStatus::kFailed, results.error};
  }
  StandingReport report{ExperimentRunStatus::kInterrupted, ""};
  const bool evaluated = results.final || results.config.eval.final_episodes == 0;
  if ((results.exit == "target" || results.exit == "budget") && evaluated) {
    report.missing_transfers = MissingTransfers(results, transfer);
    if (report.missing_transfers.empty()) return {ExperimentRunStatus::kFinished, ""};
  }
  // The newest entry: of the training, or of the evaluation on a further task.
  if (EndedBadly(logged)) {
    report.standing = ExperimentRunStatus::kFailed;
    report.problem = logged->ending->problem;
  }
  return report;
}

}  // namespace

const char* ToString(ExperimentRunStatus standing) {
  switch (standing) {
    case ExperimentRunStatus::kMissing:
      return "missing";
    case ExperimentRunStatus::kRunning:
      return "running";
    case ExperimentRunStatus::kInterrupted:
      return "interrupted";
    case ExperimentRunStatus::kFailed:
      return "failed";
    case ExperimentRunStatus::kFinished:
      return "finished";
  }
  return "?";
}

std::filesystem::path TransferFile(const std::filesystem::path& run, const std::string& task) {
  return run / kEvaluationFolder / (kTransferPrefix + task + ".json");
}

StandingReport StandingOf(const std::filesystem::path& run, const LoggedRun* logged,
                          const std::vector<std::string>& transfer) {
  if (IsHeld(run)) return {ExperimentRunStatus::kRunning, ""};
  // The configuration is written once everything has been checked and the folder is taken.
  if (!IsRun(run)) {
    if (EndedBadly(logged)) return {ExperimentRunStatus::kFailed, logged->ending->problem};
    return {ExperimentRunStatus::kMissing, ""};
  }
  try {
    return StandingOfResults(ReadRunResults(run), logged, transfer);
  } catch (const Error& e) {
    return {ExperimentRunStatus::kFailed, e.what()};
  }
}

}  // namespace shoal::launch

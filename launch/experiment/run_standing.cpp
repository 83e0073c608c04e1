// SPDX-License-Identifier: Apache-2.0
#include "launch/experiment/run_standing.h"

#include <fmt/core.h>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/run_folder/run_file_names.h"
#include "launch/experiment/run_results.h"
#include "launch/record/run_folder.h"

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
    return {RunStanding::kFailed, results.error};
  }
  StandingReport report{RunStanding::kInterrupted, ""};
  const bool evaluated = results.final || results.config.eval.final_episodes == 0;
  if ((results.exit == "target" || results.exit == "budget") && evaluated) {
    report.missing_transfers = MissingTransfers(results, transfer);
    if (report.missing_transfers.empty()) return {RunStanding::kFinished, ""};
  }
  // Of the training, or of the evaluation on a further task: whichever came last.
  if (EndedBadly(logged)) {
    report.standing = RunStanding::kFailed;
    report.problem = logged->ending->problem;
  }
  return report;
}

}  // namespace

const char* ToString(RunStanding standing) {
  switch (standing) {
    case RunStanding::kMissing:
      return "missing";
    case RunStanding::kRunning:
      return "running";
    case RunStanding::kInterrupted:
      return "interrupted";
    case RunStanding::kFailed:
      return "failed";
    case RunStanding::kFinished:
      return "finished";
  }
  return "?";
}

std::filesystem::path TransferFile(const std::filesystem::path& run, const std::string& task) {
  return run / kEvaluationFolder / (kTransferPrefix + task + ".json");
}

StandingReport StandingOf(const std::filesystem::path& run, const LoggedRun* logged,
                          const std::vector<std::string>& transfer) {
  if (IsHeld(run)) return {RunStanding::kRunning, ""};
  // The configuration is written once everything has been checked and the folder is taken.
  if (!IsRun(run)) {
    if (EndedBadly(logged)) return {RunStanding::kFailed, logged->ending->problem};
    return {RunStanding::kMissing, ""};
  }
  try {
    return StandingOfResults(ReadRunResults(run), logged, transfer);
  } catch (const Error& e) {
    return {RunStanding::kFailed, e.what()};
  }
}

}  // namespace shoal::launch

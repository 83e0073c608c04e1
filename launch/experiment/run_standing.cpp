#include "launch/experiment/run_standing.h"

#include <fmt/core.h>

#include "common/base/error.h"
#include "launch/experiment/run_results.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

// It ended by itself with an error, as opposed to being stopped or killed.
bool EndedBadly(const LoggedRun* logged) {
  return logged != nullptr && logged->ending && !logged->ending->stopped &&
         !logged->ending->by_signal && logged->ending->code != 0;
}

StandingReport StandingOfResults(const RunResults& results, const LoggedRun* logged) {
  if (results.exit == "failed" || !results.error.empty()) {
    return {RunStanding::kFailed, results.error};
  }
  const bool evaluated = results.final || results.config.eval.final_episodes == 0;
  if ((results.exit == "target" || results.exit == "budget") && evaluated) {
    return {RunStanding::kFinished, ""};
  }
  if (EndedBadly(logged)) return {RunStanding::kFailed, logged->ending->problem};
  return {RunStanding::kInterrupted, ""};
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

StandingReport StandingOf(const std::filesystem::path& run, const LoggedRun* logged) {
  if (IsHeld(run)) return {RunStanding::kRunning, ""};
  std::error_code error;
  // The configuration is written once everything has been checked and the folder is taken.
  if (!std::filesystem::exists(run / "config.json", error)) {
    if (EndedBadly(logged)) return {RunStanding::kFailed, logged->ending->problem};
    return {RunStanding::kMissing, ""};
  }
  try {
    return StandingOfResults(ReadRunResults(run), logged);
  } catch (const Error& e) {
    return {RunStanding::kFailed, e.what()};
  }
}

}  // namespace shoal::launch

// `shoal experiment run`, status and summary.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

struct ExperimentOptions {
  std::string definition;      // file, or name of one in launch/experiments
  std::vector<int64_t> seeds;  // empty = the definition's
  int jobs = 1;                // runs side by side, each with cores of its own
  std::string out;             // folder; empty = experiments/NAME
  bool retry_failed = false;
  bool dry_run = false;  // check everything, the folder included; start and make nothing
};

// Exit code of a command that was stopped by Ctrl-C, as shells have it.
inline constexpr int kInterruptedExit = 130;

// Does what is still to be done of the experiment. Progress goes to stderr; stdout gets one line of
// JSON for each run that is done with: {run, arm, seed, status, objective, path}. 0 once every run
// is finished, 1 when one is not, kInterruptedExit after Ctrl-C. Throws Error before anything is
// written where the definition, the folder or an arm is refused.
int RunExperiment(const ExperimentOptions& options);

}  // namespace shoal::launch

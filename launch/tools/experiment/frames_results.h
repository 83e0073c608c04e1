// SPDX-License-Identifier: Apache-2.0
// An experiment's mean returns at the environment frames of its definition ("frames"), beside those
// of its reference, for summary.json and for the table of the summary. The unit of the statistics
// is the seed (statistics.h).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/environment_frames.h"
#include "launch/tools/experiment/reference.h"
#include "launch/tools/experiment/run_results.h"
#include "launch/tools/experiment/seed_figures.h"

namespace shoal::launch {

struct FramesRun {
  int64_t seed = 0;
  bool failed = false;                    // a failed run has no returns
  std::vector<ReturnAtFrames> returns{};  // at those of the frames that the run has evaluated
};

struct FramesArm {
  std::string name{}, task{};
  std::vector<FramesRun> runs{};
};

// One number of a reference.
struct PublishedReturn {
  std::string method{}, task{};
  int64_t frames = 0;
  double value = 0;
};

struct FramesResults {
  std::vector<int64_t> frames{};  // empty if the definition has none
  std::vector<FramesArm> arms{};
  std::string reference{};                   // name; empty if the definition has none
  std::string source{};                      // of the reference
  std::vector<PublishedReturn> published{};  // for the tasks of `arms` and for `frames`
};

std::vector<ReturnAtFrames> ReturnsAtFrames(const RunResults& run,
                                            const std::vector<int64_t>& frames);

// Sets `reference`, `source` and `published`.
void SetReference(const Reference& reference, FramesResults* results);

// Returns of an arm's runs at `frames`. Counts the failed runs.
SeedFigures FiguresAt(const FramesArm& arm, int64_t frames);

// Whether the arms are different tasks, so that the mean over all arms is a mean over tasks.
bool AreDifferentTasks(const std::vector<FramesArm>& arms);
// For each seed with a return in all arms, the mean over the arms. Counts the seeds that failed in
// at least one arm.
SeedFigures MeanOfTasksAt(const std::vector<FramesArm>& arms, int64_t frames);

// Methods of the published returns, in the order of the reference.
std::vector<std::string> MethodsOf(const FramesResults& results);
// The published return; empty if the reference has none.
std::optional<double> PublishedAt(const FramesResults& results, const std::string& method,
                                  const std::string& task, int64_t frames);
// Mean of a method's published returns over the tasks of all arms; empty if one is missing.
std::optional<double> PublishedMeanAt(const FramesResults& results, const std::string& method,
                                      int64_t frames);

}  // namespace shoal::launch

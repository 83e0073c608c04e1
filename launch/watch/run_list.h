// SPDX-License-Identifier: Apache-2.0
// Every run of a folder with its status, for `shoal runs`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "launch/record/run_size.h"

namespace shoal::launch {

enum class RunStatus {
  kRunning,      // the run's coordinator holds the lock
  kFinished,     // reached its target or spent its budget
  kInterrupted,  // was stopped; --resume continues the run
  kFailed,
  kDead,        // the run's coordinator was killed; --resume continues the run
  kUnreadable,  // a broken meta.json or config.json, or another user's run
};
const char* ToString(RunStatus status);

// Score of an evaluation; tasks without success have only a return.
struct RunScore {
  std::optional<double> success, mean_return;
};

struct RunListing {
  std::string name;
  RunStatus status = RunStatus::kDead;
  std::string preset, task, started;
  std::string problem;  // reason of the failure, or the unreadable file
  std::string peer;     // HOST:PORT for --peer while the run is running, else empty
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;
  RunScore best, final;
  std::optional<RunSize> size;  // on the disk; empty unless requested
};

// Status of the run in a folder. Never throws because of the folder's content: a broken run gets
// the status kUnreadable.
RunListing RunStatusOf(const std::filesystem::path& run);
// The runs sorted by name, with their sizes. Never throws because of the folder's content.
std::vector<RunListing> ListRunStatus(const std::filesystem::path& dir);

// A table with one row per run. A problem is on a separate line below its run.
std::vector<std::string> FormatRunList(const std::vector<RunListing>& runs);
// JSON of schema shoal-runs-1: {schema, run_dir, runs: [{name, status, ...}]}
std::string RunListJson(const std::filesystem::path& dir, const std::vector<RunListing>& runs);

}  // namespace shoal::launch

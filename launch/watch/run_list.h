// SPDX-License-Identifier: Apache-2.0
// Every run of a folder with how it stands: what `shoal runs` shows.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "launch/record/run_size.h"

namespace shoal::launch {

enum class RunStatus {
  kRunning,      // its coordinator holds it
  kFinished,     // reached its target or spent its budget
  kInterrupted,  // was stopped; --resume goes on
  kFailed,
  kDead,        // its coordinator ended without a word, if only in the last evaluation; --resume
  kUnreadable,  // a broken meta.json or config.json, or another user's run
};
const char* ToString(RunStatus status);

// Score of an evaluation: tasks without success have a return only.
struct RunScore {
  std::optional<double> success, mean_return;
};

struct RunListing {
  std::string name;
  RunStatus status = RunStatus::kDead;
  std::string preset, task, started;
  std::string problem;  // why it failed, or what cannot be read
  std::string peer;     // HOST:PORT for --peer while it runs, else empty
  uint64_t env_steps = 0, updates = 0;
  double wall_seconds = 0;
  RunScore best, final;
  std::optional<RunSize> size;  // on the disk, where it was asked for
};

// Status of the run in a folder. Never throws because of its content: a broken run is listed as
// such.
RunListing RunStatusOf(const std::filesystem::path& run);
// By name, with their sizes. Never throws for what is in the folder: a broken run is listed as
// such.
std::vector<RunListing> ListRunStatus(const std::filesystem::path& dir);

// A table with one row per run; a problem is on a line of its own below its run.
std::vector<std::string> FormatRunList(const std::vector<RunListing>& runs);
// shoal-runs-1: {schema, run_dir, runs: [{name, status, ...}]}
std::string RunListJson(const std::filesystem::path& dir, const std::vector<RunListing>& runs);

}  // namespace shoal::launch

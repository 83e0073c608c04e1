// SPDX-License-Identifier: Apache-2.0
// runs.jsonl of an experiment. One line is written when a process is started for a run: its
// training, a resumed training, or the first missing evaluation on a further task. A second line is
// written when the started process, and the evaluations that follow, have ended. The log therefore
// also shows ends that leave no trace in the run's folder: the run was refused before its folder
// existed, or its process was killed.
//
//   {"time", "event": "started", "run", "resumed", "jobs", "cores": [...]}
//   {"time", "event": "ended", "run", "by_signal", "code", "stopped", "problem"}
//
// Several processes on several hosts may write. The file is locked while a line is written.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

// Longest wait for another process that writes the same file of the experiment.
inline constexpr std::chrono::seconds kOthersWrite{60};

struct RunStart {
  std::string run{};         // ARM-sSEED
  bool resumed = false;      // the run's folder existed already
  int jobs = 1;              // largest number of runs, or of tasks of the array, at the same time
  std::vector<int> cores{};  // cores of the run; empty = all
};

struct RunEnding {
  std::string run{};
  bool by_signal = false;
  int code = 0;           // exit code, or the signal's number
  bool stopped = false;   // the experiment was being stopped, so the code is not a failure
  std::string problem{};  // last line of the output, or the signal; empty after a success
};

// Entries of the log about one run.
struct LoggedRun {
  int starts = 0;
  int most_jobs = 0;                  // largest `jobs` of all starts
  std::vector<int> cores{};           // of the last start
  std::optional<RunEnding> ending{};  // end of the last start; empty: not logged
};

class RunLog {
 public:
  explicit RunLog(std::filesystem::path file) : file_(std::move(file)) {}

  // Both functions append a line and wait until the line is on the disk. They throw Error, also if
  // another process holds the file for kOthersWrite.
  void Write(const RunStart& start) const;
  void Write(const RunEnding& ending) const;

  // Entries by run; empty if there is no file. An incomplete line, left by a killed process, is
  // skipped. Throws Error if a line is neither of the two events.
  std::map<std::string, LoggedRun> Read() const;

 private:
  void Append(const std::string& line) const;

  const std::filesystem::path file_;
};

}  // namespace shoal::launch

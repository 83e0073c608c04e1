// SPDX-License-Identifier: Apache-2.0
// runs.jsonl of an experiment: a line when something is started for a run - its training, going on
// with it, or the first evaluation on a further task that is still missing - and one when that has
// ended, with the evaluations that followed. So an end that the run's own folder cannot tell of (it
// was refused before there was a folder, its process died) is known after any kill.
//
//   {"time", "event": "started", "run", "resumed", "jobs", "cores": [...]}
//   {"time", "event": "ended", "run", "by_signal", "code", "stopped", "problem"}
//
// Several processes may write, also of several hosts: each line is written under a lock of the
// file.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

// For others to leave a file of the experiment that both write.
inline constexpr std::chrono::seconds kOthersWrite{60};

struct RunStart {
  std::string run{};         // ARM-sSEED
  bool resumed = false;      // its folder was there
  int jobs = 1;              // runs side by side that the command allowed, or tasks of its array
  std::vector<int> cores{};  // it might use; empty = all there are
};

struct RunEnding {
  std::string run{};
  bool by_signal = false;
  int code = 0;           // exit code, or the signal's number
  bool stopped = false;   // the experiment was being stopped: the code is no failure
  std::string problem{};  // what it said last, or the signal, where it did not end well
};

// Entries of the log about one run.
struct LoggedRun {
  int starts = 0;
  int most_jobs = 0;                  // of any start
  std::vector<int> cores{};           // of the last start
  std::optional<RunEnding> ending{};  // of the last start; empty: none was seen
};

class RunLog {
 public:
  explicit RunLog(std::filesystem::path file) : file_(std::move(file)) {}

  // Append a line and wait until it is on the disk. Throw Error, also where others hold the file
  // for a minute.
  void Write(const RunStart& start) const;
  void Write(const RunEnding& ending) const;

  // By run; empty without a file. A line that a kill cut short is left out. Throws Error on JSON
  // that is none of the two events.
  std::map<std::string, LoggedRun> Read() const;

 private:
  void Append(const std::string& line) const;

  const std::filesystem::path file_;
};

}  // namespace shoal::launch

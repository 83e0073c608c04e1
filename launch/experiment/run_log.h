// runs.jsonl of an experiment: a line when the training of a run is started and one when it has
// ended, so that an end that the run's own folder cannot tell of (it was refused before there was a
// folder, its process died) is known after any kill.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

struct RunStart {
  std::string run{};  // name within the experiment
  bool resumed = false;
  int jobs = 1;              // runs side by side that the command allowed
  std::vector<int> cores{};  // it might use; empty = all there are
};

struct RunEnding {
  std::string run{};
  bool by_signal = false;
  int code = 0;           // exit code, or the signal's number
  bool stopped = false;   // the experiment was being stopped
  std::string problem{};  // what it said last, where it did not end well
};

// What the log knows of one run.
struct LoggedRun {
  int starts = 0;
  int most_jobs = 0;                  // of any start
  std::vector<int> cores{};           // of the last start
  std::optional<RunEnding> ending{};  // of the last start; empty: none was seen
};

class RunLog {
 public:
  explicit RunLog(std::filesystem::path file) : file_(std::move(file)) {}

  // Append a line that survives this process. Throw Error.
  void Write(const RunStart& start) const;
  void Write(const RunEnding& ending) const;

  // By run. A last line cut short by a kill is left out. Throws Error on a file that holds anything
  // else.
  std::map<std::string, LoggedRun> Read() const;

 private:
  void Append(const std::string& line) const;

  const std::filesystem::path file_;
};

}  // namespace shoal::launch

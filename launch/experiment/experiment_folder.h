// The folder of an experiment:
//
//   experiment.json   the definition and the base as it was resolved at the first run: both hold
//   configs/ARM.json  what `shoal train` of an arm is given
//   runs/ARM-sSEED/   the runs, each an ordinary run folder
//   logs/ARM-sSEED.log  what `shoal train` said
//   runs.jsonl        when which run was started and how that ended (run_log.h)
//   summary.json      after every run (summary.h)
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "launch/experiment/definition.h"
#include "launch/experiment/run_log.h"

namespace shoal::launch {

struct ExperimentRun {
  size_t arm = 0;  // in the definition
  int64_t seed = 0;
  std::string name{};              // ARM-sSEED
  std::filesystem::path folder{};  // of the run
};

// An experiment as its folder holds it. Reads only.
struct StoredExperiment {
  std::filesystem::path folder{};
  Definition definition{};
  Config base{};
  std::string created{};  // UTC

  // Arms x seeds, seed by seed, so that an experiment cut short has whole comparisons.
  std::vector<ExperimentRun> Runs(const std::vector<int64_t>& seeds) const;
  // Of every seed that the definition names and every seed there is a run of.
  std::vector<ExperimentRun> Runs() const;
  std::filesystem::path LogFile(const ExperimentRun& run) const;
  RunLog Log() const { return RunLog(folder / "runs.jsonl"); }
};

// Throws Error: no experiment.json, or a broken one.
StoredExperiment ReadExperiment(const std::filesystem::path& folder);

// Whether the folder holds an experiment.
bool IsExperiment(const std::filesystem::path& folder);

// Holds an experiment against a second command until destruction (or death).
class ExperimentFolder {
 public:
  // Makes the folder, or opens the one that is there and may get further arms and seeds. Throws
  // Error (usage) before anything is written where the folder holds another experiment (another
  // name, base, `set` or final_episodes, or an arm of that name with other keys) or something else,
  // or where another process runs it.
  ExperimentFolder(const std::filesystem::path& folder, const Definition& definition,
                   const std::string& source);
  ~ExperimentFolder();
  ExperimentFolder(const ExperimentFolder&) = delete;
  ExperimentFolder& operator=(const ExperimentFolder&) = delete;

  const StoredExperiment& experiment() const { return experiment_; }

 private:
  void Lock();

  StoredExperiment experiment_;
  int lock_ = -1;
};

// Whether a process runs the experiment of this folder.
bool IsExperimentHeld(const std::filesystem::path& folder);

}  // namespace shoal::launch

#include "launch/experiment/train_keeper.h"

#include <sched.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/usable_cores.h"
#include "common/config/config_io.h"
#include "launch/experiment/run_results.h"
#include "launch/processes/process_plan.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kProgram[] = "shoal";

// As a resolved configuration, which `shoal train --config` takes without asking for the preset.
void WriteArmConfig(const fs::path& file, const Config& config) {
  nlohmann::ordered_json object;
  object["schema"] = kConfigSchema;
  object.update(ToJson(config));
  WriteFileAtomically(file, object.dump(2) + "\n");
}

fs::path TransferFile(const ExperimentRun& run, const std::string& task) {
  return run.folder / "eval" / ("on-" + task + ".json");
}

// "shoal: error: REASON" -> REASON.
std::string ReasonIn(const fs::path& log) {
  const std::string line = LastLine(log), prefix = std::string(kProgram) + ": error: ";
  return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
}

// A folder that was taken by a run which was killed before it had begun: nothing is in it that
// anybody would miss.
void RemoveUnbegun(const fs::path& run) {
  std::error_code error;
  if (!fs::exists(run, error) || fs::exists(run / "config.json", error)) return;
  fs::remove_all(run, error);
  if (error) throw RuntimeError("cannot remove '{}': {}", run.string(), error.message());
}

}  // namespace

std::vector<int> OwnCores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cores;
  if (sched_getaffinity(0, sizeof set, &set) == 0) {
    for (int core = 0; core < CPU_SETSIZE; ++core) {
      if (CPU_ISSET(static_cast<size_t>(core), &set)) cores.push_back(core);
    }
  }
  // The quota may grant less time than there are CPUs.
  const auto usable = static_cast<size_t>(UsableCores());
  if (cores.size() > usable) cores.resize(usable);
  return cores;
}

std::vector<std::vector<int>> SplitCores(const std::vector<int>& cores, int jobs) {
  const auto parts = static_cast<size_t>(jobs);
  if (cores.size() < parts) {
    throw UsageError("--jobs {}: this process may use {} core(s), at least one for each run", jobs,
                     cores.size());
  }
  std::vector<std::vector<int>> split(parts);
  auto next = cores.begin();
  for (size_t i = 0; i < parts; ++i) {
    const size_t size = cores.size() / parts + (i < cores.size() % parts ? 1 : 0);
    split[i].assign(next, next + static_cast<ptrdiff_t>(size));
    next += static_cast<ptrdiff_t>(size);
  }
  return split;
}

std::vector<std::string> MissingTransfers(const StoredExperiment& experiment,
                                          const ExperimentRun& run) {
  std::vector<std::string> missing;
  const Definition& definition = experiment.definition;
  const Config config = ArmConfig(experiment.base, definition.arms[run.arm], definition.name);
  for (const std::string& task : definition.transfer) {
    const bool same = task == config.task && config.randomization.body_mass.empty();
    if (!same && !fs::exists(TransferFile(run, task))) missing.push_back(task);
  }
  return missing;
}

TrainKeeper::TrainKeeper(const StoredExperiment& experiment, int jobs)
    : experiment_(experiment), log_(experiment.Log()), slots_(static_cast<size_t>(jobs)) {
  if (jobs == 1) return;
  const auto parts = SplitCores(OwnCores(), jobs);
  for (size_t i = 0; i < slots_.size(); ++i) slots_[i].cores = parts[i];
}

StandingReport TrainKeeper::TrainingStanding(const ExperimentRun& run) const {
  const auto logged = log_.Read();
  const auto known = logged.find(run.name);
  return StandingOf(run.folder, known == logged.end() ? nullptr : &known->second);
}

StandingReport TrainKeeper::Standing(const ExperimentRun& run) {
  StandingReport report = TrainingStanding(run);
  if (report.standing == RunStanding::kFinished && !MissingTransfers(experiment_, run).empty()) {
    const auto ending = log_.Read()[run.name].ending;
    if (ending && ending->code != 0 && !ending->stopped && !ending->by_signal) {
      return {RunStanding::kFailed, ending->problem};
    }
    return {RunStanding::kInterrupted, ""};
  }
  return report;
}

ProcessSpec TrainKeeper::Training(const ExperimentRun& run) const {
  if (fs::exists(run.folder / "config.json")) {
    return ProgramSpec(kProgram, {"train", "--resume", run.folder.string()}, 1);
  }
  RemoveUnbegun(run.folder);
  const Arm& arm = experiment_.definition.arms[run.arm];
  const fs::path config = experiment_.folder / "configs" / (arm.name + ".json");
  WriteArmConfig(config, ArmConfig(experiment_.base, arm, experiment_.definition.name));
  return ProgramSpec(
      kProgram,
      {"train", "--config", config.string(), "--run-name", run.name, "--set",
       "run_dir=" + run.folder.parent_path().string(), "--set", fmt::format("seed={}", run.seed)},
      1);
}

std::optional<ProcessSpec> TrainKeeper::NextTransfer(const ExperimentRun& run) const {
  const std::vector<std::string> missing = MissingTransfers(experiment_, run);
  if (missing.empty()) return std::nullopt;
  const Config config = ArmConfig(experiment_.base, experiment_.definition.arms[run.arm], run.name);
  return ProgramSpec(
      kProgram,
      {"eval", "--checkpoint", JudgedCheckpoint(run.folder).string(), "--task", missing[0],
       "--episodes", std::to_string(std::max(1, config.eval.final_episodes)), "--seed",
       std::to_string(run.seed), "--json", TransferFile(run, missing[0]).string()},
      1);
}

void TrainKeeper::Launch(ProcessSpec spec, Slot& slot) {
  spec.role = "train";
  spec.output = experiment_.LogFile(*slot.run);
  spec.cores = slot.cores;
  slot.process.emplace(spec);
}

void TrainKeeper::Start(const ExperimentRun& run, int slot_number) {
  Slot& slot = slots_[static_cast<size_t>(slot_number)];
  const bool trained = TrainingStanding(run).standing == RunStanding::kFinished;
  ProcessSpec spec = trained ? *NextTransfer(run) : Training(run);
  log_.Write({.run = run.name,
              .resumed = fs::exists(run.folder / "config.json"),
              .jobs = static_cast<int>(slots_.size()),
              .cores = slot.cores});
  slot.run = run;
  Launch(std::move(spec), slot);
}

bool TrainKeeper::Ended(int slot_number) {
  Slot& slot = slots_[static_cast<size_t>(slot_number)];
  const auto status = slot.process->Poll();
  if (!status) return false;
  slot.process.reset();
  if (status->Clean() && !stopping_ &&
      TrainingStanding(*slot.run).standing == RunStanding::kFinished) {
    if (auto next = NextTransfer(*slot.run)) {
      Launch(std::move(*next), slot);
      return false;
    }
  }
  LogEnding(*slot.run, *status);
  slot.run.reset();
  return true;
}

void TrainKeeper::LogEnding(const ExperimentRun& run, const ExitStatus& status) const {
  log_.Write({.run = run.name,
              .by_signal = status.by_signal,
              .code = status.code,
              .stopped = stopping_,
              .problem = status.Clean()     ? ""
                         : status.by_signal ? status.Describe()
                                            : ReasonIn(experiment_.LogFile(run))});
}

void TrainKeeper::Stop() {
  stopping_ = true;
  for (Slot& slot : slots_) {
    if (slot.process) slot.process->Signal(SIGINT);
  }
}

}  // namespace shoal::launch

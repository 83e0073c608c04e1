// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/process_runner.h"

#include <sched.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/usable_cores.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr char kProgram[] = "shoal";

// Writes the resolved configuration, which `shoal train --config` takes without the preset.
void WriteArmConfig(const fs::path& file, const Config& config) {
  nlohmann::ordered_json object;
  object["schema"] = kConfigSchema;
  object.update(ToJson(config));
  WriteFileAtomically(file, object.dump(2) + "\n");
}

// "shoal: error: REASON" -> REASON.
std::string ReasonIn(const fs::path& log) {
  const std::string line = LastLine(log), prefix = std::string(kProgram) + ": error: ";
  return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
}

// Removes the folder of a run that was killed before it began. Such a folder has no results.
void RemoveUnbegun(const fs::path& run) {
  std::error_code error;
  if (!fs::exists(run, error) || IsRun(run)) return;
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
  // The CPU quota may allow fewer cores than the affinity mask.
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

ProcessRunner::ProcessRunner(const StoredExperiment& experiment, int jobs, int side_by_side)
    : experiment_(experiment),
      log_(experiment.Log()),
      side_by_side_(side_by_side),
      slots_(static_cast<size_t>(jobs)) {
  if (jobs == 1) return;
  const auto parts = SplitCores(OwnCores(), jobs);
  for (size_t i = 0; i < slots_.size(); ++i) slots_[i].cores = parts[i];
}

StandingReport ProcessRunner::Standing(const ExperimentRun& run) {
  return experiment_.Standing(run, log_.Read());
}

ProcessSpec ProcessRunner::Training(const ExperimentRun& run) const {
  if (IsRun(run.folder)) {
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

ProcessSpec ProcessRunner::Transfer(const ExperimentRun& run, const std::string& task) const {
  const Config config = ArmConfig(experiment_.base, experiment_.definition.arms[run.arm], run.name);
  return ProgramSpec(
      kProgram,
      {"eval", "--checkpoint", JudgedCheckpoint(run.folder).string(), "--task", task, "--episodes",
       std::to_string(std::max(1, config.eval.final_episodes)), "--seed", std::to_string(run.seed),
       "--json", TransferFile(run.folder, task).string()},
      1);
}

void ProcessRunner::Launch(ProcessSpec spec, Slot& slot) {
  spec.role = "train";
  spec.output = experiment_.LogFile(*slot.run);
  spec.cores = slot.cores;
  slot.process.emplace(spec);
}

void ProcessRunner::Start(const ExperimentRun& run, int slot_number) {
  Slot& slot = slots_[static_cast<size_t>(slot_number)];
  const std::vector<std::string> transfers = Standing(run).missing_transfers;
  ProcessSpec spec = transfers.empty() ? Training(run) : Transfer(run, transfers[0]);
  log_.Write(
      {.run = run.name, .resumed = IsRun(run.folder), .jobs = side_by_side_, .cores = slot.cores});
  slot.run = run;
  Launch(std::move(spec), slot);
}

bool ProcessRunner::Ended(int slot_number) {
  Slot& slot = slots_[static_cast<size_t>(slot_number)];
  const auto status = slot.process->Poll();
  if (!status) return false;
  slot.process.reset();
  if (status->Clean() && !stopping_) {
    const std::vector<std::string> transfers = Standing(*slot.run).missing_transfers;
    if (!transfers.empty()) {
      Launch(Transfer(*slot.run, transfers[0]), slot);
      return false;
    }
  }
  LogEnding(*slot.run, *status);
  slot.run.reset();
  return true;
}

void ProcessRunner::LogEnding(const ExperimentRun& run, const ExitStatus& status) const {
  log_.Write({.run = run.name,
              .by_signal = status.by_signal,
              .code = status.code,
              .stopped = stopping_,
              .problem = status.Clean() || stopping_ ? ""
                         : status.by_signal          ? status.Describe()
                                                     : ReasonIn(experiment_.LogFile(run))});
}

void ProcessRunner::Stop() {
  stopping_ = true;
  for (Slot& slot : slots_) {
    if (slot.process) slot.process->Signal(SIGINT);
  }
}

}  // namespace shoal::launch

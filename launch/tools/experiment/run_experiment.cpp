// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/run_experiment.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/file_lock.h"
#include "common/base/interrupted.h"
#include "common/base/or_null.h"
#include "common/base/stop.h"
#include "launch/processes/actor_program.h"
#include "launch/tools/experiment/process_runner.h"
#include "launch/tools/experiment/run_queue.h"
#include "launch/tools/experiment/slurm_array.h"
#include "launch/tools/experiment/summary.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds kPoll{200};
constexpr seconds kProgressPeriod{60};

void Say(const std::string& line) {
  fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

// Null if the run has no outcome yet.
const RunOutcome* OutcomeOf(const ExperimentOutcome& outcome, const ExperimentRun& run) {
  for (const RunOutcome& other : outcome.arms[run.arm].runs) {
    if (other.run.name == run.name) return &other;
  }
  return nullptr;
}

// Prints the JSON line that hyperparameter tuners read.
void PrintJsonLine(const ExperimentOutcome& outcome, const ExperimentRun& run,
                   const StandingReport& report) {
  const RunOutcome* found = OutcomeOf(outcome, run);
  const ordered_json line{
      {"run", run.name},
      {"arm", outcome.arms[run.arm].name},
      {"seed", run.seed},
      {"status", ToString(report.standing)},
      {"objective", found && found->results ? OrNull(found->results->Objective()) : nullptr},
      {"path", run.folder.string()}};
  fmt::print("{}\n", line.dump());
  std::fflush(stdout);
}

// Prints one line a minute for each active run.
class ProgressLines {
 public:
  explicit ProgressLines(const StoredExperiment& experiment) : experiment_(experiment) {}

  void Tick() {
    if (Now() - last_ < kProgressPeriod) return;
    last_ = Now();
    for (const ArmOutcome& arm : ReadOutcome(experiment_).arms) {
      for (const RunOutcome& run : arm.runs) {
        if (run.report.standing != ExperimentRunStatus::kRunning || !run.results) continue;
        Say(fmt::format("  {}: {} of {} env steps, {} updates", run.run.name,
                        run.results->env_steps, run.results->config.env_steps,
                        run.results->updates));
      }
    }
  }

 private:
  const StoredExperiment& experiment_;
  SteadyTime last_ = Now();
};

// Computes the observations of each arm, so that a camera or model file that does not exist is
// found before the first run.
void CheckObservations(const ExperimentPlan& plan) {
  for (size_t i = 0; i < plan.arms.size(); ++i) {
    try {
      DescribeObservations(plan.arms[i]);
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& e) {
      throw Error(static_cast<ErrorKind>(e.exit_code()),
                  fmt::format("{}: arm '{}': {}", plan.source,
                              plan.experiment.definition.arms[i].name, e.what()));
    }
  }
}

// Measures what these runs are compared with. Returns false if a stop was requested before the last
// baseline.
bool MeasureBaselines(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs) {
  for (const JudgedWorld& world : JudgedWorlds(WithArmsOf(runs, experiment))) {
    if (!HasBaselines(world.config)) {
      Say(fmt::format("no baselines of {}: environments of Python have none", world.name));
      continue;
    }
    if (!BaselineCache().Measure(world.config, StopRequested, Say)) return false;
  }
  return true;
}

// Returns the present outcome and writes it to summary.json. Reads and writes under a lock, so that
// the last of several processes includes the results of the others.
ExperimentOutcome Summarize(const StoredExperiment& experiment) {
  const fs::path file = experiment.folder / ".summary.lock";
  const auto lock = FileLock::Take(file, Holding::kAlone, kOthersWrite);
  if (!lock)
    throw RuntimeError("cannot write the summary: another process has locked '{}'", file.string());
  ExperimentOutcome outcome = ReadOutcome(experiment);
  WriteSummary(outcome);
  return outcome;
}

// Throws Error (usage) that names the existing runs.
ExperimentRun RunNamed(const StoredExperiment& experiment, const std::string& name) {
  if (const auto run = experiment.RunNamed(name)) return *run;
  std::vector<std::string> names;
  for (const Arm& arm : experiment.definition.arms) names.push_back(arm.name + "-sSEED");
  throw UsageError("experiment '{}' has no run '{}', expected one of {}",
                   experiment.folder.string(), name, fmt::join(names, ", "));
}

// Throws Error (usage) if the definition lacks one of the arms.
void CheckArms(const Definition& definition, const std::vector<std::string>& asked) {
  std::vector<std::string> names;
  for (const Arm& arm : definition.arms) names.push_back(arm.name);
  for (const std::string& name : asked) {
    if (std::ranges::count(names, name) == 0) {
      throw UsageError("--arms: experiment '{}' has no arm '{}', expected some of {}",
                       definition.name, name, fmt::join(names, ", "));
    }
  }
}

// Returns the runs of the requested arms and seeds.
std::vector<ExperimentRun> RunsAskedFor(const StoredExperiment& experiment,
                                        const ExperimentOptions& options) {
  const Definition& definition = experiment.definition;
  std::vector<ExperimentRun> runs =
      experiment.Runs(options.seeds.empty() ? definition.seeds : options.seeds);
  if (!options.arms.empty()) {
    std::erase_if(runs, [&](const ExperimentRun& run) {
      return std::ranges::count(options.arms, definition.arms[run.arm].name) == 0;
    });
  }
  return runs;
}

int ExitCode(const ExperimentOutcome& outcome, const std::vector<ExperimentRun>& runs) {
  if (StopRequested()) return kInterruptedExit;
  for (const ExperimentRun& run : runs) {
    const RunOutcome* found = OutcomeOf(outcome, run);
    if (found == nullptr || found->report.standing != ExperimentRunStatus::kFinished) return 1;
  }
  return 0;
}

// Does the runs on this machine. `side_by_side`: see ProcessRunner.
ExperimentOutcome DoRunsHere(const StoredExperiment& experiment,
                             const std::vector<ExperimentRun>& runs, const QueueTerms& terms,
                             int side_by_side) {
  ProcessRunner keeper(experiment, terms.jobs, side_by_side);
  ProgressLines progress(experiment);
  const auto done = [&](const ExperimentRun& run, const StandingReport& report) {
    PrintJsonLine(Summarize(experiment), run, report);
  };
  DoRuns(runs, terms, keeper,
         {.stops = [] { return StopRequested() ? std::max(1, StopRequests()) : 0; },
          .wait =
              [&] {
                progress.Tick();
                std::this_thread::sleep_for(kPoll);
              },
          .say = Say,
          .done = done});
  return Summarize(experiment);
}

int Submit(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
           const ExperimentOptions& options) {
  const std::vector<ExperimentRun> missing = StillToBeDone(experiment, runs, options.retry_failed);
  if (missing.empty()) {
    Say("no run is left to submit, except failed ones (--retry-failed)");
    return 0;
  }
  const SlurmArray array = SubmitArray(
      experiment, missing, {.at_once = options.jobs, .sbatch_options = options.sbatch_options});
  Say(
      fmt::format("submitted job {}: {} run(s), {}; once it has ended, the same command submits "
                  "the remaining runs",
                  array.job, missing.size(), array.script.string()));
  fmt::print("{}\n", ToJson(array).dump());
  return 0;
}

}  // namespace

int RunExperiment(const ExperimentOptions& options) {
  InstallStopSignals();
  const fs::path source = FindDefinition(options.definition);
  const Definition definition = ReadDefinition(source);
  CheckArms(definition, options.arms);
  const fs::path folder =
      options.out.empty() ? ExperimentsIn().dir / definition.name : fs::path(options.out);
  const int jobs = options.jobs.value_or(1);
  if (!options.slurm) SplitCores(OwnCores(), jobs);  // throws if there are too few cores
  const ExperimentPlan plan = PlanExperiment(folder, definition, source);
  CheckObservations(plan);
  if (options.dry_run) {
    Say(fmt::format("{}: {} arm(s) x {} seed(s) are valid", definition.name,
                    options.arms.empty() ? definition.arms.size() : options.arms.size(),
                    (options.seeds.empty() ? definition.seeds : options.seeds).size()));
    return 0;
  }
  const ExperimentFolder held(plan);
  const StoredExperiment& experiment = held.experiment();
  const std::vector<ExperimentRun> runs = RunsAskedFor(experiment, options);
  Say(fmt::format("experiment {} in {}: {} runs; their output is in {}/logs", definition.name,
                  experiment.folder.string(), runs.size(), experiment.folder.string()));
  if (!MeasureBaselines(experiment, runs)) {
    Summarize(experiment);
    Say("stopped before the first run: the same command continues");
    return kInterruptedExit;
  }
  if (options.slurm) {
    Summarize(experiment);
    return Submit(experiment, runs, options);
  }
  const ExperimentOutcome outcome =
      DoRunsHere(experiment, runs, {.jobs = jobs, .retry_failed = options.retry_failed}, jobs);
  Say(SummaryText(outcome) +
      fmt::format("summary: {}", (experiment.folder / "summary.json").string()));
  return ExitCode(outcome, runs);
}

int RunExperimentTask(const ExperimentTask& task) {
  InstallStopSignals();
  const ExperimentShare shared(task.folder);
  const StoredExperiment& experiment = shared.experiment();
  const std::vector<ExperimentRun> runs{RunNamed(experiment, task.run)};
  return ExitCode(
      DoRunsHere(experiment, runs, {.retry_failed = task.retry_failed}, task.side_by_side), runs);
}

}  // namespace shoal::launch

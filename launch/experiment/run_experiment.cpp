#include "launch/experiment/run_experiment.h"

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <thread>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "launch/experiment/run_queue.h"
#include "launch/experiment/summary.h"
#include "launch/experiment/train_keeper.h"
#include "launch/processes/actor_program.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr char kFolder[] = "experiments";
constexpr milliseconds kPoll{200};
constexpr seconds kProgressPeriod{60};

void Say(const std::string& line) {
  fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

template <class T>
ordered_json OrNull(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

const RunOutcome& OutcomeOf(const ExperimentOutcome& outcome, const ExperimentRun& run) {
  for (const RunOutcome& other : outcome.arms[run.arm].runs) {
    if (other.run.name == run.name) return other;
  }
  throw RuntimeError("run '{}' is gone", run.folder.string());
}

// What a tuner reads.
void PrintJsonLine(const ExperimentOutcome& outcome, const ExperimentRun& run,
                   const StandingReport& report) {
  const RunOutcome& found = OutcomeOf(outcome, run);
  const ordered_json line{
      {"run", run.name},
      {"arm", outcome.arms[run.arm].name},
      {"seed", run.seed},
      {"status", ToString(report.standing)},
      {"objective", found.results ? OrNull(found.results->Objective()) : nullptr},
      {"path", run.folder.string()}};
  fmt::print("{}\n", line.dump());
  std::fflush(stdout);
}

// A line a minute for each run under way.
class ProgressLines {
 public:
  explicit ProgressLines(const StoredExperiment& experiment) : experiment_(experiment) {}

  void Tick() {
    if (Now() - last_ < kProgressPeriod) return;
    last_ = Now();
    for (const ArmOutcome& arm : ReadOutcome(experiment_).arms) {
      for (const RunOutcome& run : arm.runs) {
        if (run.report.standing != RunStanding::kRunning || !run.results) continue;
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

// What actors of each arm would observe: a camera or model file that does not exist is found before
// the first run, not hours later.
void CheckArms(const Definition& definition, const Config& base, const std::string& source) {
  for (const Arm& arm : definition.arms) {
    try {
      DescribeObservations(ArmConfig(base, arm, source));
    } catch (const Error& e) {
      const std::string prefix = fmt::format("{}: arm '{}'", source, arm.name);
      if (std::string(e.what()).starts_with(prefix)) throw;
      throw Error(static_cast<ErrorKind>(e.exit_code()), fmt::format("{}: {}", prefix, e.what()));
    }
  }
  CheckTransfer(definition, source);
}

int ExitCode(const ExperimentOutcome& outcome, const std::vector<ExperimentRun>& runs) {
  if (StopRequests() > 0) return kInterruptedExit;
  for (const ExperimentRun& run : runs) {
    if (OutcomeOf(outcome, run).report.standing != RunStanding::kFinished) return 1;
  }
  return 0;
}

}  // namespace

int RunExperiment(const ExperimentOptions& options) {
  InstallStopSignals();
  const fs::path source = FindDefinition(options.definition);
  const Definition definition = ReadDefinition(source);
  const fs::path folder =
      options.out.empty() ? fs::path(kFolder) / definition.name : fs::path(options.out);
  if (options.jobs > 1) SplitCores(OwnCores(), options.jobs);  // refuses too many
  const Config base =
      IsExperiment(folder) ? ReadExperiment(folder).base : ResolveBase(definition, source);
  CheckArms(definition, base, source);
  if (options.dry_run) {
    Say(fmt::format("{}: {} arm(s) x {} seed(s) are good", definition.name, definition.arms.size(),
                    (options.seeds.empty() ? definition.seeds : options.seeds).size()));
    return 0;
  }
  const ExperimentFolder held(folder, definition, source);
  const StoredExperiment& experiment = held.experiment();
  const std::vector<ExperimentRun> runs =
      experiment.Runs(options.seeds.empty() ? definition.seeds : options.seeds);
  Say(fmt::format("experiment {} in {}: {} runs; what each says: {}/logs", definition.name,
                  experiment.folder.string(), runs.size(), experiment.folder.string()));
  for (const Config& config : JudgedConfigs(experiment)) {
    BaselineCache().Measure(config, StopRequested, Say);
  }
  TrainKeeper keeper(experiment, options.jobs);
  ProgressLines progress(experiment);
  const auto done = [&](const ExperimentRun& run, const StandingReport& report) {
    const ExperimentOutcome outcome = ReadOutcome(experiment);
    WriteSummary(outcome);
    PrintJsonLine(outcome, run, report);
  };
  DoRuns(runs, {.jobs = options.jobs, .retry_failed = options.retry_failed}, keeper,
         {.stops = [] { return StopRequested() ? std::max(1, StopRequests()) : 0; },
          .wait =
              [&] {
                progress.Tick();
                std::this_thread::sleep_for(kPoll);
              },
          .say = Say,
          .done = done});
  const ExperimentOutcome outcome = ReadOutcome(experiment);
  WriteSummary(outcome);
  Say(SummaryText(outcome) +
      fmt::format("summary: {}", (experiment.folder / "summary.json").string()));
  return ExitCode(outcome, runs);
}

fs::path FindExperiment(const std::string& name_or_folder) {
  const fs::path named = fs::path(kFolder) / name_or_folder;
  for (const fs::path& path : {fs::path(name_or_folder), named}) {
    if (IsExperiment(path)) return path;
  }
  throw UsageError("no experiment '{}': neither '{}' nor '{}' has an experiment.json",
                   name_or_folder, name_or_folder, named.string());
}

}  // namespace shoal::launch

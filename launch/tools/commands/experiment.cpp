// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "launch/tools/commands/commands.h"
#include "launch/tools/experiment/merged_summary.h"
#include "launch/tools/experiment/run_experiment.h"
#include "launch/tools/experiment/stored_summary.h"
#include "launch/tools/experiment/summary.h"

namespace shoal::launch {
namespace {

int Status(const std::string& name) {
  const std::filesystem::path folder = FindNamed(name, ExperimentsIn());
  std::cout << StatusText(ReadOutcome(ReadExperiment(folder)));
  if (!IsExperimentHeld(folder)) std::cout << "no command is running it now\n";
  return 0;
}

int Summary(const std::vector<std::string>& names, bool json) {
  const auto is_file = [](const std::string& name) { return name.ends_with(".json"); };
  if (std::ranges::all_of(names, is_file)) {
    const auto summary = ReadMergedSummary({names.begin(), names.end()});
    std::cout << (json ? summary.dump(2) + "\n" : StoredSummaryText(summary)) << std::flush;
    return 0;
  }
  if (names.size() > 1) {
    throw UsageError("'{}': expected one experiment, or only files (*.json) of summaries",
                     *std::ranges::find_if_not(names, is_file));
  }
  const ExperimentOutcome outcome =
      ReadOutcome(ReadExperiment(FindNamed(names[0], ExperimentsIn())));
  std::cout << (json ? ToJson(outcome).dump(2) + "\n" : SummaryText(outcome)) << std::flush;
  return 0;
}

template <class T>
void CheckUnique(const char* option, const std::vector<T>& values) {
  for (const T& value : values) {
    if (std::ranges::count(values, value) > 1) {
      throw UsageError("{}: {} is given twice", option, value);
    }
  }
}

void AddRun(CLI::App& experiment, Action* chosen) {
  CLI::App* command = experiment.add_subcommand(
      "run",
      "Train the remaining runs of an experiment: finished runs are skipped, interrupted runs "
      "continue. Progress on stderr; on stdout one line of JSON per run. Ctrl-C stops cleanly.");
  const auto options = std::make_shared<ExperimentOptions>();
  command
      ->add_option("experiment", options->definition,
                   "Definition: a file (*.json), or the name of one that Shoal provides")
      ->required();
  command->add_option("--seeds", options->seeds, "Seeds instead of the definition's: 0,1,2")
      ->delimiter(',')
      ->check(CLI::NonNegativeNumber);
  command->add_option("--arms", options->arms, "Arms instead of all: NAME,NAME")->delimiter(',');
  command
      ->add_option("--jobs", options->jobs,
                   "Number of runs side by side, each on its own cores; their wall times are "
                   "marked; default 1. With --slurm: tasks at a time; default all")
      ->check(CLI::Range(1, 1024));
  command->add_option("--out", options->out, "Folder; experiments/NAME by default");
  command->add_flag("--retry-failed", options->retry_failed, "Try failed runs again");
  command->add_flag("--dry-run", options->dry_run, "Check everything, start nothing");
  CLI::Option* const slurm =
      command->add_flag("--slurm", options->slurm,
                        "Submit the remaining runs as a Slurm job array, one run per task");
  command
      ->add_option("--sbatch", options->sbatch_options,
                   "Option of sbatch, which overrides the script's: --sbatch=--partition=short; "
                   "may be repeated")
      ->needs(slurm);
  command->callback([=] {
    CheckUnique("--seeds", options->seeds);
    CheckUnique("--arms", options->arms);
    *chosen = [=] { return RunExperiment(*options); };
  });
}

void AddSlurmTask(CLI::App& experiment, Action* chosen) {
  CLI::App* command = experiment.add_subcommand(
      "task", "Train one run of an experiment; each task of a job array calls this command.");
  const auto task = std::make_shared<ExperimentTask>();
  command->add_option("experiment", task->folder, "Folder of the experiment")->required();
  command->add_option("run", task->run, "ARM-sSEED")->required();
  command
      ->add_option("--side-by-side", task->side_by_side,
                   "Tasks that may run at the same time; more than 1 marks their wall times")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_flag("--retry-failed", task->retry_failed, "Try it again if it has failed");
  command->callback([=] { *chosen = [=] { return RunExperimentTask(*task); }; });
}

void AddStatus(CLI::App& experiment, Action* chosen) {
  CLI::App* command =
      experiment.add_subcommand("status", "Show the state of each run of an experiment.");
  const auto name = std::make_shared<std::string>();
  command->add_option("experiment", *name, "Name within experiments/, or folder")->required();
  command->callback([=] { *chosen = [=] { return Status(*name); }; });
}

void AddSummary(CLI::App& experiment, Action* chosen) {
  CLI::App* command = experiment.add_subcommand(
      "summary",
      "Show the results of an experiment so far: success, return and ratios with intervals. A "
      "summary.json gives the same from its rows alone; several files, from different machines, "
      "give the results of all their runs.");
  const auto names = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<bool>(false);
  command
      ->add_option("experiment", *names,
                   "Name within experiments/, folder, or *.json of one or more summaries")
      ->required();
  command->add_flag("--json", *json, "Print JSON (schema shoal-experiment-1)");
  command->callback([=] { *chosen = [=] { return Summary(*names, *json); }; });
}

}  // namespace

void AddExperimentCommand(CLI::App& app, Action* chosen) {
  CLI::App* experiment = app.add_subcommand(
      "experiment", "Train and compare arms x seeds of one definition (docs/experiments.md).");
  experiment->require_subcommand(1);
  AddRun(*experiment, chosen);
  AddSlurmTask(*experiment, chosen);
  AddStatus(*experiment, chosen);
  AddSummary(*experiment, chosen);
}

}  // namespace shoal::launch

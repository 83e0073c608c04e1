// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <memory>

#include "common/config/config_io.h"
#include "launch/commands/commands.h"
#include "launch/commands/tool_commands.h"
#include "launch/run/training_run.h"

namespace shoal::launch {
namespace {

std::string PresetHelp() {
  std::string names;
  for (const std::string& name : ListPresets()) names += (names.empty() ? "" : ", ") + name;
  return "Configuration to start from: " + names;
}

}  // namespace

void AddTrainCommand(CLI::App& app, Action* chosen) {
  CLI::App* command = app.add_subcommand(
      "train",
      "Train a policy: starts replay, learner, actors and evaluation, watches and stops them, and "
      "evaluates the best checkpoint. Ctrl-C stops cleanly and skips the evaluation (--resume "
      "continues); a second Ctrl-C stops at once. Ctrl-Z pauses the run. Keys (shoal config) are "
      "options, too: --seed 3, --steps 20000, --learner.batch 256, and so are the names that other "
      "programs use: --env, --algo, --lr, --batch-size, --gamma, --threads.");
  const auto options = std::make_shared<TrainOptions>();
  const auto describe_keys = std::make_shared<bool>(false);
  command->add_option("--preset", options->preset, PresetHelp());
  command->add_option("--config", options->config_file, "JSON file of keys, applied on the preset");
  command->add_option("--set", options->set, "KEY=VALUE, applied last; may be repeated")
      ->allow_extra_args(false);
  command->add_flag("--lockstep", options->lockstep, "Repeat bit for bit (one actor, slower)");
  command->add_option("--run-name", options->run_name, "Name of the run's folder; also --name");
  command->add_option("--run-dir", options->run_dir, "Folder that holds the runs (run_dir)");
  command->add_flag("--overwrite", options->overwrite, "Delete a run of that name first");
  command->add_option("--hosts", options->hosts,
                      "JSON file of other hosts that run actors (docs/cluster.md)");
  command->add_option("--secure", options->secure,
                      "Folder of credentials (shoal secure init): authenticated and encrypted");
  command->add_option("--resume", options->resume, "Continue a stopped run: its name or folder");
  auto* init_from = command->add_option("--init-from", options->init_from,
                                        "safetensors file that the networks start from: of a "
                                        "checkpoint, or with --name-map of another program");
  command
      ->add_option("--name-map", options->name_map,
                   "JSON file that maps Shoal's tensor names to those of --init-from")
      ->needs(init_from);
  command->add_flag("--in-process", options->in_process,
                    "Run replay, learner and actors as threads of this process, for a debugger "
                    "(docs/debugger.md)");
  command->add_flag("--detach", options->detach,
                    "Return once the run has started; watch it with shoal attach or shoal top");
  command->add_option("--prometheus", options->prometheus,
                      "PORT (on 127.0.0.1) or ADDRESS:PORT to serve metrics at, for Prometheus");
  auto* print_config =
      command->add_flag("--print-config", options->print_config, "Print every key and exit");
  auto* dry_run =
      command->add_flag("--dry-run", options->dry_run, "Check everything, start nothing");
  auto* describe =
      command->add_flag("--describe-keys", *describe_keys, "Print a table of all keys and exit");
  command
      ->add_flag("--film", options->film,
                 "After the final evaluation, film the best checkpoint (shoal film)")
      ->excludes(print_config)
      ->excludes(dry_run)
      ->excludes(describe);
  command->callback([=] {
    *chosen = [=] {
      if (options->film) CheckToolsAreBuilt({"film"});
      if (!*describe_keys) return RunTraining(*options);
      std::fputs(DescribeKeys().c_str(), stdout);
      return 0;
    };
  });
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/target_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace shoal::launch {

namespace {

constexpr char kTarget[] = "Name or folder of the run; default: the only running run";

void AddRunDir(CLI::App& command, std::string* run_dir) {
  command.add_option("--run-dir", *run_dir, "Folder that holds the runs")->capture_default_str();
}

void AddPeer(CLI::App& command, TargetOptions* options) {
  command.add_option("--peer", options->peer,
                     "HOST:PORT of a run on any host, as shoal train printed it at its start");
  command.add_option("--secure", options->secure,
                     "Folder of credentials of a secured run, with --peer (shoal secure init)");
}

}  // namespace

CLI::Option* AddRunOption(CLI::App& command, std::string* run, std::string* run_dir,
                          const std::string& meaning) {
  CLI::Option* option = command.add_option("run,--run", *run, meaning);
  AddRunDir(command, run_dir);
  return option;
}

void AddTargetOptions(CLI::App& command, TargetOptions* options) {
  AddRunOption(command, &options->run, &options->run_dir, kTarget);
  AddPeer(command, options);
}

void AddNamedTargetOptions(CLI::App& command, TargetOptions* options) {
  command.add_option("--run", options->run, kTarget);
  AddRunDir(command, &options->run_dir);
  AddPeer(command, options);
}

CLI::Option* AddCheckpointOptions(CLI::App& command, CheckpointWords* words) {
  command.add_option(
      "run,--run", words->run,
      "Run (name or folder), which stands for its best checkpoint; or RUN/checkpoints/NAME");
  CLI::Option* checkpoint =
      command.add_option("--checkpoint", words->checkpoint,
                         "Name in RUN/checkpoints: best, step_N; without RUN as the argument");
  AddRunDir(command, &words->run_dir);
  return checkpoint;
}

void ExpectPng(CLI::Option* option) {
  option->check([](const std::string& file) {
    return std::filesystem::path(file).extension() == ".png"
               ? ""
               : "'" + file + "': expected a name that ends in .png";
  });
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/target_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace shoal::launch {

void AddTargetOptions(CLI::App& command, TargetOptions* options) {
  command.add_option("--run", options->run,
                     "Name or folder of the run; the only one that is running when not given");
  command.add_option("--peer", options->peer,
                     "HOST:PORT of a run anywhere, as the run showed it when it started");
  command.add_option("--secure", options->secure,
                     "Folder of credentials of a secured run, with --peer (shoal secure init)");
  command.add_option("--run-dir", options->run_dir, "Folder that holds the runs")
      ->capture_default_str();
}

void ExpectPng(CLI::Option* option) {
  option->check([](const std::string& file) {
    return std::filesystem::path(file).extension() == ".png"
               ? ""
               : "'" + file + "': expected a name that ends in .png";
  });
}

}  // namespace shoal::launch

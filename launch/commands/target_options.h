// SPDX-License-Identifier: Apache-2.0
// Options that several commands have.
#pragma once

#include <string>
#include <vector>

#include "launch/record/named_checkpoint.h"
#include "launch/watch/run_target.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace shoal::launch {

// Adds the options with which every command accepts a run: an argument or --run with a name or
// folder, and --run-dir, the folder of named runs. The strings are borrowed and must live as long
// as the command line.
CLI::Option* AddRunOption(CLI::App& command, std::string* run, std::string* run_dir,
                          const std::string& meaning = "Run: name or folder");

// Adds the options for a running run: those of AddRunOption, --peer and --secure.
void AddTargetOptions(CLI::App& command, TargetOptions* options);
// Like AddTargetOptions, for a command that has other arguments: only --run names the run.
void AddNamedTargetOptions(CLI::App& command, TargetOptions* options);

// Adds the options for a checkpoint: a run or a folder as the argument, --checkpoint and --run-dir.
// Returns the option --checkpoint.
CLI::Option* AddCheckpointOptions(CLI::App& command, CheckpointWords* words);

// Refuses a file name that does not end in .png, because the command writes PNG.
void ExpectPng(CLI::Option* option);

}  // namespace shoal::launch

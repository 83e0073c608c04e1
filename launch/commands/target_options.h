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

// How every command takes a run: as an argument or with --run, by name or folder; and --run-dir,
// where names are looked for. What is borrowed must live as long as the command line.
CLI::Option* AddRunOption(CLI::App& command, std::string* run, std::string* run_dir,
                          const std::string& meaning = "Run: name or folder");

// A running run: AddRunOption, --peer and --secure.
void AddTargetOptions(CLI::App& command, TargetOptions* options);
// For a command that has further arguments besides the run: only --run names the run.
void AddNamedTargetOptions(CLI::App& command, TargetOptions* options);

// A checkpoint: a run or a folder as the argument, --checkpoint and --run-dir. The command's
// option --checkpoint.
CLI::Option* AddCheckpointOptions(CLI::App& command, CheckpointWords* words);

// Refuses a file whose name does not end in .png: what is written there is PNG.
void ExpectPng(CLI::Option* option);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Options that several commands have.
#pragma once

#include "launch/watch/run_target.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace shoal::launch {

// Adds --run, --peer, --secure and --run-dir. `options` must live as long as the command line.
void AddTargetOptions(CLI::App& command, TargetOptions* options);

// Refuses a file whose name does not end in .png: what is written there is PNG.
void ExpectPng(CLI::Option* option);

}  // namespace shoal::launch

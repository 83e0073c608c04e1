// SPDX-License-Identifier: Apache-2.0
// Command lines to copy from reports and cards.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// A command line for a shell; only words that need quotes are quoted.
std::string CommandLine(const std::vector<std::string>& words);

// Command that trains a run again from its own configuration, into runs/NAME-again. The command
// sets run_dir, because the run_dir of `config` may be another folder, as for an experiment's run.
std::string TrainAgain(const std::filesystem::path& config, const std::string& name);

}  // namespace shoal::launch

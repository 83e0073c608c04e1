// SPDX-License-Identifier: Apache-2.0
// Commands that people copy out of reports and cards.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// A command line for a shell: quotes only words that need it.
std::string CommandLine(const std::vector<std::string>& words);

// Trains a run again from its own configuration, into runs/NAME-again: `config` may say another
// run_dir, as that of an experiment's run does.
std::string TrainAgain(const std::filesystem::path& config, const std::string& name);

}  // namespace shoal::launch

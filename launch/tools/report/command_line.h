// SPDX-License-Identifier: Apache-2.0
// Commands that people copy out of reports and cards.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// As a shell takes it: quotes only where a word needs them.
std::string CommandLine(const std::vector<std::string>& words);

// Trains a run again from its own configuration, into runs/NAME-again: `config` may say another
// run_dir, as that of an experiment's run does.
std::string TrainAgain(const std::filesystem::path& config, const std::string& name);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/command_line.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "launch/processes/remote_host.h"

namespace shoal::launch {

std::string CommandLine(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    const bool plain = !word.empty() && std::ranges::all_of(word, [](const char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
             std::string_view("-_./=:,").find(c) != std::string_view::npos;
    });
    if (!line.empty()) line += ' ';
    line += plain ? word : ShellLine({word});
  }
  return line;
}

std::string TrainAgain(const std::filesystem::path& config, const std::string& name) {
  return CommandLine({"shoal", "train", "--config", config.string(), "--run-name", name + "-again",
                      "--set", "run_dir=runs"});
}

}  // namespace shoal::launch

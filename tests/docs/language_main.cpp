// SPDX-License-Identifier: Apache-2.0
// shoal-language [FILE...]: prints the faults of language of the tree, or of files of it.
// shoal-language --lower: writes the allowance of tests/docs anew where files have fewer faults.
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/docs/language_allowance.h"
#include "tests/support/paths.h"

namespace {

void Lower(const shoal::FaultsByFile& faults) {
  const std::string file = shoal::SourcePath("tests/docs/language_allowance.txt");
  const shoal::LanguageAllowance lowered =
      shoal::Lowered(shoal::ReadAllowance(shoal::ReadFile(file)), shoal::CountFaults(faults));
  shoal::WriteFileForOthers(file, shoal::AllowanceText(lowered));
}

void Print(const shoal::FaultsByFile& faults, const std::vector<std::string>& files) {
  for (const auto& [file, found] : faults) {
    if (!files.empty() && std::ranges::find(files, file) == files.end()) continue;
    for (const shoal::LanguageFault& fault : found) {
      fmt::print("{}:{}: {}: {}\n", file, fault.line, fault.rule, fault.text);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    const shoal::FaultsByFile faults = shoal::FindLanguageFaults(shoal::SourcePath(""));
    if (arguments == std::vector<std::string>{"--lower"}) {
      Lower(faults);
    } else {
      Print(faults, arguments);
    }
  } catch (const shoal::Error& e) {
    fmt::print(stderr, "shoal-language: error: {}\n", e.what());
    return 1;
  }
  return 0;
}

// SPDX-License-Identifier: Apache-2.0
// shoal-language [FILE...]: prints the language faults of the given files, or of the whole tree.
#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "tests/docs/language.h"
#include "tests/support/paths.h"

int main(int argc, char** argv) {
  const std::vector<std::string> files(argv + 1, argv + argc);
  try {
    for (const auto& [file, found] : shoal::FindLanguageFaults(shoal::SourcePath(""))) {
      if (!files.empty() && std::ranges::find(files, file) == files.end()) continue;
      for (const shoal::LanguageFault& fault : found) {
        fmt::print("{}:{}: {}: {}\n", file, fault.line, fault.rule, fault.text);
      }
    }
  } catch (const shoal::Error& e) {
    fmt::print(stderr, "shoal-language: error: {}\n", e.what());
    return 1;
  }
  return 0;
}

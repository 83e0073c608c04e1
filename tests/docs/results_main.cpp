// SPDX-License-Identifier: Apache-2.0
// shoal-results: generates the tables of docs/results.md from the figures in docs/results.
#include <fmt/core.h>

#include <exception>
#include <string>

#include "common/base/files.h"
#include "tests/docs/results_table.h"
#include "tests/support/paths.h"

int main(int argc, char**) {
  if (argc > 1) {
    fmt::print(stderr, "usage: shoal-results (no arguments; writes docs/results.md)\n");
    return 2;
  }
  try {
    const std::string page = shoal::SourcePath("docs/results.md");
    const std::string tables = shoal::ResultsTables(shoal::SourcePath("docs/results"));
    shoal::WriteFileForOthers(page, shoal::WithResults(shoal::ReadFile(page), tables));
  } catch (const std::exception& e) {
    fmt::print(stderr, "shoal-results: error: {}\n", e.what());
    return 1;
  }
  return 0;
}

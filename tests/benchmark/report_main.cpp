// SPDX-License-Identifier: Apache-2.0
// shoal-bench-report: tables and comparisons from files of schema shoal-bench-1.
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/main_guard.h"
#include "tests/benchmark/bench_page.h"
#include "tests/benchmark/bench_report.h"

namespace {

using shoal::bench::Report;

std::vector<Report> ReadAll(const std::vector<std::string>& files) {
  std::vector<Report> reports;
  for (const std::string& file : files) {
    reports.push_back(shoal::bench::ParseReport(shoal::ReadFile(file), file));
  }
  return reports;
}

void PrintComparison(const std::vector<std::string>& ours, const std::vector<std::string>& theirs) {
  if (ours.size() != theirs.size()) {
    throw shoal::UsageError("{} files of ours and {} of theirs: one each per repetition is wanted",
                            ours.size(), theirs.size());
  }
  const std::vector<Report> our = ReadAll(ours), their = ReadAll(theirs);
  fmt::print("{} against {}, {} repetitions of each in turn\n\n", our[0].commit, their[0].commit,
             our.size());
  fmt::print("| stage | ours | theirs | ratio | spread |\n| --- | --- | --- | --- | --- |\n");
  for (const auto& row : shoal::bench::Compare(our, their)) {
    fmt::print("| {} (against {}) | {:.4g} {} | {:.4g} | {:.3f} | {:.2f} |\n", row.stage,
               row.against, row.ours, row.unit, row.theirs, row.ratio, row.spread);
  }
}

void RewritePage(const std::filesystem::path& page) {
  const auto read = [&](const std::string& file) {
    return shoal::ReadFile(page.parent_path() / file);
  };
  shoal::WriteFileForOthers(page, shoal::bench::RewritePage(shoal::ReadFile(page), read));
}

int Run(int argc, char** argv) {
  std::vector<std::string> ours, theirs;
  std::vector<std::string> pages;
  CLI::App app("Makes tables of files that shoal-bench and its like have written.",
               "shoal-bench-report");
  shoal::AddVersion(&app);
  app.require_subcommand(1);
  auto* compare = app.add_subcommand("compare", "two commits, stage by stage");
  compare->add_option("--ours", ours, "files, one per repetition")->required();
  compare->add_option("--theirs", theirs, "files of the other commit, as many")->required();
  auto* tables = app.add_subcommand("tables", "writes the tables of pages anew");
  tables->add_option("PAGES", pages, "Markdown with lines '<!-- bench FILE: ROWS -->'")->required();
  if (const auto exit_code = shoal::ParseCommandLine(&app, argc, argv)) return *exit_code;
  if (compare->parsed()) PrintComparison(ours, theirs);
  for (const std::string& page : pages) RewritePage(page);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-bench-report", [&] { return Run(argc, argv); });
}

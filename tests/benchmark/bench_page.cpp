// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/bench_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <sstream>
#include <vector>

#include "common/base/error.h"
#include "tests/benchmark/bench_report.h"
#include "tests/benchmark/host_split.h"
#include "tests/benchmark/scale_model.h"

namespace shoal::bench {
namespace {

using Reader = std::function<std::string(const std::string& file)>;

constexpr std::string_view kBegin = "<!-- bench ", kEnd = "<!-- end of bench -->";
constexpr std::string_view kScale = "scale of ", kHosts = "hosts of ", kBy = " by ";

// The text up to the next line break, which is taken away, too.
std::string_view TakeLine(std::string_view* text) {
  const size_t end = text->find('\n');
  const std::string_view line = text->substr(0, end);
  text->remove_prefix(end == std::string_view::npos ? text->size() : end + 1);
  return line;
}

// The text between "<!-- bench " and " -->".
std::string_view OrderOf(std::string_view line) {
  const size_t end = line.find(" -->");
  if (end == std::string_view::npos) throw RuntimeError("no ' -->' ends '{}'", line);
  return line.substr(kBegin.size(), end - kBegin.size());
}

std::string Source(const Report& report, const std::string& file) {
  return fmt::format("Commit {}, {}.\n[File]({}).\n", report.commit, report.machine, file);
}

// Parts of "A; B", of which a stage has to contain one.
std::vector<std::string_view> PartsOf(std::string_view only) {
  std::vector<std::string_view> parts;
  for (size_t end = only.find("; "); end != std::string_view::npos; end = only.find("; ")) {
    parts.push_back(only.substr(0, end));
    only.remove_prefix(end + 2);
  }
  parts.push_back(only);
  return parts;
}

std::string Rows(std::string_view order, const Reader& read) {
  const size_t colon = order.find(": ");
  const std::string file(order.substr(0, colon));
  const std::vector<std::string_view> parts =
      PartsOf(colon == std::string_view::npos ? std::string_view() : order.substr(colon + 2));
  Report report = ParseReport(read(file), file);
  const auto has = [](const ReportedRow& row, std::string_view part) {
    return row.stage.find(part) != std::string::npos;
  };
  for (const std::string_view part : parts) {
    const auto matches = [&](const ReportedRow& row) { return has(row, part); };
    if (std::ranges::none_of(report.rows, matches)) {
      throw RuntimeError("'{}' has no row '{}'", file, part);
    }
  }
  std::erase_if(report.rows, [&](const ReportedRow& row) {
    return std::ranges::none_of(parts, [&](std::string_view part) { return has(row, part); });
  });
  return fmt::format("{}\n{}", Source(report, file), MarkdownTable(report));
}

struct Reports {
  std::vector<Report> all;
  std::string sources;
};

Reports ReadReports(std::string_view names, const Reader& read) {
  std::istringstream files{std::string(names)};
  Reports reports;
  for (std::string file; files >> file;) {
    reports.all.push_back(ParseReport(read(file), file));
    reports.sources += Source(reports.all.back(), file);
  }
  return reports;
}

std::string Scale(std::string_view order, const Reader& read) {
  const Reports reports = ReadReports(order.substr(kScale.size()), read);
  return fmt::format("{}\n{}", reports.sources, ScaleTables(ReadScaleConstants(reports.all)));
}

// "hosts of FILES by FILE", the last of schema shoal-scaling-1.
std::string Hosts(std::string_view order, const Reader& read) {
  const size_t by = order.find(kBy);
  if (by == std::string_view::npos) throw RuntimeError("'{}' names no file after '{}'", order, kBy);
  const Reports reports = ReadReports(order.substr(kHosts.size(), by - kHosts.size()), read);
  const std::string file(order.substr(by + kBy.size()));
  return fmt::format("{}Learner threads: [file]({}).\n\n{}", reports.sources, file,
                     HostTable(reports.all, LearnerSpeed(read(file), file)));
}

std::string Made(std::string_view order, const Reader& read) {
  if (order.starts_with(kScale)) return Scale(order, read);
  if (order.starts_with(kHosts)) return Hosts(order, read);
  return Rows(order, read);
}

}  // namespace

std::string RewritePage(std::string_view page, const Reader& read) {
  std::string out;
  while (!page.empty()) {
    const std::string_view line = TakeLine(&page);
    if (line.starts_with(kEnd)) throw RuntimeError("a line '{}' ends nothing", kEnd);
    out += fmt::format("{}\n", line);
    if (!line.starts_with(kBegin)) continue;
    std::string_view former;
    do {
      if (page.empty()) throw RuntimeError("'{}' has no '{}'", line, kEnd);
      former = TakeLine(&page);
      if (former.starts_with(kBegin)) throw RuntimeError("'{}' has no '{}'", line, kEnd);
    } while (!former.starts_with(kEnd));
    const std::string_view order = OrderOf(line);
    out += fmt::format("\n{}\n{}\n", Made(order, read), kEnd);
  }
  return out;
}

}  // namespace shoal::bench

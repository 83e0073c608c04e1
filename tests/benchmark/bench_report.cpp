// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/bench_report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::bench {
namespace {

using Json = nlohmann::json;

std::optional<double> NumberOf(const Json& row, const char* key) {
  const auto found = row.find(key);
  if (found == row.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string TextOf(const Json& object, const char* key, const std::string& source) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_string()) {
    throw RuntimeError("'{}' has no text '{}' where shoal-bench-1 has one", source, key);
  }
  return found->get<std::string>();
}

double Median(std::vector<double> values) {
  std::ranges::sort(values);
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

// Four digits, without an exponent: 0.0084, 43.21, 15330.
std::string Short(double value) {
  const double size = std::abs(value);
  if (size >= 1000) return fmt::format("{:.0f}", value);
  if (size >= 100) return fmt::format("{:.1f}", value);
  return fmt::format("{:.{}f}", value, size >= 1 ? 2 : 4);
}

std::string LimitOf(const ReportedRow& row) {
  if (row.at_most) {
    return fmt::format("at most {}{}", Short(*row.at_most),
                       row.figure > *row.at_most ? ": **missed**" : "");
  }
  if (!row.target) return "";
  const bool missed = !row.ratio || *row.ratio < *row.target;
  return fmt::format("{:.2f}{}", *row.target, missed ? ": **missed**" : "");
}

const ReportedRow* Find(const Report& report, const ReportedRow& like) {
  const auto same = [&](const ReportedRow& row) {
    return row.stage == like.stage && row.against == like.against;
  };
  const auto found = std::ranges::find_if(report.rows, same);
  return found == report.rows.end() ? nullptr : &*found;
}

}  // namespace

Report ParseReport(std::string_view text, const std::string& source) {
  const Json file = ParseBoundedJson<Json>(text);
  if (!file.is_object() || file.value("schema", Json()) != "shoal-bench-1" ||
      !file.contains("rows") || !file["rows"].is_array() || !file.contains("machine") ||
      !file["machine"].is_object()) {
    throw RuntimeError("'{}' is no file of schema shoal-bench-1", source);
  }
  Report report;
  const Json& machine = file["machine"];
  report.commit = TextOf(file, "commit", source);
  report.machine =
      fmt::format("{}, {:.0f} cores, {}", TextOf(machine, "cpu", source),
                  NumberOf(machine, "cores").value_or(0), TextOf(machine, "isa", source));
  for (const Json& row : file["rows"]) {
    const auto figure = row.is_object() ? NumberOf(row, "figure") : std::nullopt;
    if (!figure) throw RuntimeError("a row of '{}' has no figure", source);
    report.rows.push_back({.stage = TextOf(row, "stage", source),
                           .unit = TextOf(row, "unit", source),
                           .against = TextOf(row, "against", source),
                           .figure = *figure,
                           .against_figure = NumberOf(row, "against_figure"),
                           .ratio = NumberOf(row, "ratio"),
                           .target = NumberOf(row, "target"),
                           .at_most = NumberOf(row, "at_most"),
                           .spread = NumberOf(row, "spread")});
  }
  return report;
}

std::string MarkdownTable(const Report& report) {
  std::string table =
      "| stage | figure | against | ratio | limit | spread |\n| --- | --- | --- | --- | --- | --- "
      "|\n";
  for (const ReportedRow& row : report.rows) {
    const auto optional = [](const std::optional<double>& value) {
      return value ? fmt::format("{:.2f}", *value) : "";
    };
    const std::string against =
        row.against_figure ? fmt::format("{} ({})", row.against, Short(*row.against_figure))
                           : row.against;
    table +=
        fmt::format("| {} | {} {} | {} | {} | {} | {} |\n", row.stage, Short(row.figure), row.unit,
                    against, optional(row.ratio), LimitOf(row), optional(row.spread));
  }
  return table;
}

std::vector<Comparison> Compare(std::span<const Report> ours, std::span<const Report> theirs) {
  CHECK(!ours.empty() && ours.size() == theirs.size())
      << ours.size() << " and " << theirs.size() << " reports";
  std::vector<Comparison> comparisons;
  for (const ReportedRow& row : ours[0].rows) {
    std::vector<double> of_ours, of_theirs, ratios;
    for (size_t i = 0; i < ours.size(); ++i) {
      const ReportedRow *our = Find(ours[i], row), *their = Find(theirs[i], row);
      if (our == nullptr || their == nullptr) break;
      of_ours.push_back(our->figure);
      of_theirs.push_back(their->figure);
      ratios.push_back(our->figure / their->figure);
    }
    if (ratios.size() < ours.size()) continue;
    const auto [least, most] = std::ranges::minmax(ratios);
    const double ratio = Median(ratios);
    comparisons.push_back({.stage = row.stage,
                           .unit = row.unit,
                           .against = row.against,
                           .ours = Median(of_ours),
                           .theirs = Median(of_theirs),
                           .ratio = ratio,
                           .spread = (most - least) / ratio});
  }
  return comparisons;
}

}  // namespace shoal::bench

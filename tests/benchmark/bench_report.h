// SPDX-License-Identifier: Apache-2.0
// Reads files of schema shoal-bench-1 and writes tables and comparisons of two commits. Pure
// functions of texts.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::bench {

// A row of the file. It has at most one limit: the ratio should be at least `target`, or the figure
// at most `at_most`.
struct ReportedRow {
  std::string stage, unit, against;
  double figure = 0;
  std::optional<double> against_figure, ratio, target, at_most, spread;
};

struct Report {
  std::string commit, machine;  // "AMD EPYC, 2 cores, avx512_core_bf16"
  std::vector<ReportedRow> rows;
};

// Throws Error naming `source` if the text does not follow the schema.
Report ParseReport(std::string_view text, const std::string& source);

// The rows as a Markdown table.
std::string MarkdownTable(const Report& report);

// One stage of two commits.
struct Comparison {
  std::string stage, unit, against;
  double ours = 0, theirs = 0;  // medians
  double ratio = 0;             // median of ours / theirs, repetition by repetition
  double spread = 0;            // (largest - smallest ratio) / ratio
};

// Compares the rows that all reports have. The reports are in the order of the repetitions. CHECKs
// that both sides have the same number of reports, at least one.
std::vector<Comparison> Compare(std::span<const Report> ours, std::span<const Report> theirs);

}  // namespace shoal::bench

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

// A row of the file. A row has at most one limit: `ratio` should be at least `target`, or `figure`
// should be at most `at_most`.
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

// Comparison of one stage between two commits.
struct Comparison {
  std::string stage, unit, against;
  double ours = 0, theirs = 0;  // medians
  double ratio = 0;             // median over the repetitions of ours / theirs
  double spread = 0;            // (largest - smallest ratio) / ratio
};

// Compares the rows that all reports have. The reports are in the order of the repetitions. CHECKs
// that both sides have the same number of reports, at least one.
std::vector<Comparison> Compare(std::span<const Report> ours, std::span<const Report> theirs);

}  // namespace shoal::bench

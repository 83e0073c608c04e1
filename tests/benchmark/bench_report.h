// SPDX-License-Identifier: Apache-2.0
// Reads files of schema shoal-bench-1 and makes of them what people read: tables, and how two
// commits compare. Pure functions of texts.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shoal::bench {

// A row of the file. A limit is one of two: the ratio is meant to be at least `target`, or the
// figure itself at most `at_most`.
struct ReportedRow {
  std::string stage, unit, against;
  double figure = 0;
  std::optional<double> against_figure, ratio, target, at_most, spread;
};

struct Report {
  std::string commit, machine;  // "AMD EPYC, 2 cores, avx512_core_bf16"
  std::vector<ReportedRow> rows;
};

// Throws Error naming `source` when the text is no such file.
Report ParseReport(std::string_view text, const std::string& source);

// The rows, a line each, as a Markdown table.
std::string MarkdownTable(const Report& report);

// One stage of two commits.
struct Comparison {
  std::string stage, unit, against;
  double ours = 0, theirs = 0;  // medians
  double ratio = 0;             // median of ours / theirs, repetition by repetition
  double spread = 0;            // (largest - smallest ratio) / ratio
};

// Reports of both sides, as many, in the order of the repetitions. Of the rows that all have. CHECK
// that there are some, of both as many.
std::vector<Comparison> Compare(std::span<const Report> ours, std::span<const Report> theirs);

}  // namespace shoal::bench

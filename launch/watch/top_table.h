// SPDX-License-Identifier: Apache-2.0
// `shoal top` as text: one row per process, sorted by any column; or one line. Pure.
#pragma once

#include <string>
#include <vector>

#include "common/wire/messages.h"

namespace shoal::launch {

// Sort order of the rows. Column 0 sorts by role; columns of numbers sort from the largest to the
// smallest.
struct TopOrder {
  int column = 0;
  bool reversed = false;
};

int TopColumns();
// The heading of a column.
std::string TopColumnName(int column);
// Description of each column, one line of at most 79 characters each.
std::vector<std::string> DescribeTopColumns();

// Largest width of each column so far, while a table is watched. Widths only grow, so that columns
// do not move.
using TopWidths = std::vector<size_t>;

// The run as one line, advice, a heading, then one row per process; each at most `width` characters
// (0 = no limit): longer text is wrapped, and the least important columns are left out. A * marks
// the column by which the rows are sorted. `widths`: widths of the earlier tables, empty for the
// first table; may be null.
std::vector<std::string> FormatTop(const RunViewMessage& view, const TopOrder& order, int width,
                                   TopWidths* widths = nullptr);
// The whole run as one plain line.
std::string FormatTopLine(const RunViewMessage& view);
// The rows of the table as text in cells, under `columns`, in the order of roles.
struct TopCells {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
TopCells MakeTopCells(const RunViewMessage& view);
// The table as JSON of schema shoal-top-1, indented.
std::string TopJson(const RunViewMessage& view);

}  // namespace shoal::launch

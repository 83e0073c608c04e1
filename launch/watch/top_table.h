// SPDX-License-Identifier: Apache-2.0
// `shoal top` as text: one row per process, sorted by any column; or one line. Pure.
#pragma once

#include <string>
#include <vector>

#include "common/wire/messages.h"

namespace shoal::launch {

// Sort order of the rows. Column 0 is the order of roles; numbers are sorted from the largest down.
struct TopOrder {
  int column = 0;
  bool reversed = false;
};

int TopColumns();
// The heading of a column.
std::string TopColumnName(int column);
// Description of each column, one line of at most 79 characters each.
std::vector<std::string> DescribeTopColumns();

// The widths that columns have had while a table is watched: widths only grow, so that columns do
// not move.
using TopWidths = std::vector<size_t>;

// The run as one line, advice, a heading, then one row per process; each at most `width` characters
// (0 = no limit): longer text is wrapped, and the least important columns are left out. The column
// that the rows are sorted by is marked with a *. `widths`: widths of the earlier tables, empty for
// the first one; may be null.
std::vector<std::string> FormatTop(const RunViewMessage& view, const TopOrder& order, int width,
                                   TopWidths* widths = nullptr);
// The whole run as one plain line.
std::string FormatTopLine(const RunViewMessage& view);
// The same rows as text in cells, under `columns`, in the order of roles.
struct TopCells {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};
TopCells MakeTopCells(const RunViewMessage& view);
// shoal-top-1, indented.
std::string TopJson(const RunViewMessage& view);

}  // namespace shoal::launch

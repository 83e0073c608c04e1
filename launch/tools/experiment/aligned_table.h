// SPDX-License-Identifier: Apache-2.0
// Tables for the terminal.
#pragma once

#include <string>
#include <vector>

namespace shoal::launch {

using TableRow = std::vector<std::string>;

// One line per row, cells left-aligned, each column as wide as its widest cell, two spaces between
// columns, no spaces at the end of a line. No row may have more cells than the first.
std::string AlignedTable(const std::vector<TableRow>& rows);

}  // namespace shoal::launch

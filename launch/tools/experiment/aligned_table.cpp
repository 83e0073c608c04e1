// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/aligned_table.h"

#include <fmt/core.h>

#include <algorithm>

#include "common/base/check.h"

namespace shoal::launch {

std::string AlignedTable(const std::vector<TableRow>& rows) {
  CHECK(!rows.empty());
  std::vector<size_t> widths(rows[0].size());
  for (const TableRow& row : rows) {
    CHECK(row.size() <= widths.size()) << row.size();
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const TableRow& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace shoal::launch

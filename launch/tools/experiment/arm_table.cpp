// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/arm_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace shoal::launch {
namespace {

using Cells = std::array<std::string, 5>;

Cells CellsOf(const ArmRow& arm) {
  std::string finished = fmt::format("{}/{}", arm.figures.returns.size(), arm.runs);
  if (arm.figures.failed > 0) finished += fmt::format(", {} failed", arm.figures.failed);
  return {arm.name, finished, FormatSuccess(arm.figures), FormatReturn(arm.figures),
          FormatDistance(arm.figures)};
}

}  // namespace

void SetAggregates(const SeedFigures& figures, nlohmann::ordered_json* arm) {
  (*arm)["success"] = SuccessJson(figures);
  (*arm)["return"] = ReturnJson(figures);
  (*arm)["final_distance"] = DistanceJson(figures);
}

std::string ArmTable(const std::vector<ArmRow>& arms) {
  std::vector<Cells> rows{
      {"ARM", "FINISHED", "SUCCESS [95 %]", "RETURN [95 %]", "DISTANCE, cm [95 %]"}};
  for (const ArmRow& arm : arms) rows.push_back(CellsOf(arm));
  std::array<size_t, 5> widths{};
  for (const Cells& row : rows) {
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const Cells& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) line += fmt::format("{:<{}}  ", row[i], widths[i]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace shoal::launch

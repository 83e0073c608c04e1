// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/arm_table.h"

#include <fmt/core.h>

#include "launch/tools/experiment/aligned_table.h"

namespace shoal::launch {
namespace {

TableRow CellsOf(const ArmRow& arm) {
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
  std::vector<TableRow> rows{
      {"ARM", "FINISHED", "SUCCESS [95 %]", "RETURN [95 %]", "DISTANCE, cm [95 %]"}};
  for (const ArmRow& arm : arms) rows.push_back(CellsOf(arm));
  return AlignedTable(rows);
}

}  // namespace shoal::launch

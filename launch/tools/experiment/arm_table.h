// SPDX-License-Identifier: Apache-2.0
// Aggregates of an experiment's arms, for summary.json and for the table of the summary.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "launch/tools/experiment/seed_figures.h"

namespace shoal::launch {

constexpr char kSummarySchema[] = "shoal-experiment-1";

// Values of a summary's n_to_target_rule. `together`: the first consecutive evaluations whose
// pooled episodes reach the target (launch/record/first_reached.h). `each`: the first two
// consecutive evaluations that both reach the target. Older builds, whose summaries name no rule,
// used the rule `each`.
constexpr char kReachedTogether[] = "together", kReachedByEach[] = "each";

// Sets `success`, `return` and `final_distance` of an arm's object.
void SetAggregates(const SeedFigures& figures, nlohmann::ordered_json* arm);

struct ArmRow {
  std::string name{};
  SeedFigures figures{};
  size_t runs = 0;
};
// Table text: a line of headings and a line per arm, in aligned columns.
std::string ArmTable(const std::vector<ArmRow>& arms);

}  // namespace shoal::launch

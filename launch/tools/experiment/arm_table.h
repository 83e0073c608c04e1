// SPDX-License-Identifier: Apache-2.0
// The aggregates of an experiment's arms, as summary.json and the summary's table have them.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "launch/tools/experiment/seed_figures.h"

namespace shoal::launch {

constexpr char kSummarySchema[] = "shoal-experiment-1";

// Values of a summary's n_to_target_rule. `together`: the first evaluations in a row whose pooled
// episodes reach the target (launch/record/first_reached.h). `each`: the first two of which each
// reaches it, the rule of builds whose summaries do not name one.
constexpr char kReachedTogether[] = "together", kReachedByEach[] = "each";

// Sets `success`, `return` and `final_distance` of an arm's object.
void SetAggregates(const SeedFigures& figures, nlohmann::ordered_json* arm);

struct ArmRow {
  std::string name{};
  SeedFigures figures{};
  size_t runs = 0;
};
// Lines of equal columns below a line of headings.
std::string ArmTable(const std::vector<ArmRow>& arms);

}  // namespace shoal::launch

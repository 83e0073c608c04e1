// SPDX-License-Identifier: Apache-2.0
// `shoal env observability`: how well sets of cameras show a quantity of a task. Choose cameras by
// this measure rather than by the look of a picture.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/config/config.h"

namespace shoal::launch {

struct ObservabilityRequest {
  std::string task;
  // Sets of cameras that are compared; empty: each of the task's cameras alone and each pair.
  std::vector<std::vector<std::string>> cameras;
  std::vector<std::string> labels;  // as sac.aux
  bool goal_hidden = false;         // the goal's marker, as where goals are relabelled
  int width = 84, height = 84;
  std::string quality = "fast", encoder = "compact";
  int samples = 6000;
  int updates = 1500;
  int64_t seed = 1;
};

struct ObservabilityRow {
  std::vector<std::string> cameras;
  // By label: root mean square distance in the label's unit over its numbers together; and that of
  // saying always the mean.
  std::vector<double> error, of_mean;
};

struct Observability {
  ObservabilityRequest request;
  int trained = 0, held_out = 0;       // frames
  std::vector<ObservabilityRow> rows;  // in the order asked for
};

// `on_row`: told of each row when it is done. `stop`: asked often; true ends, with the rows that
// are done. Throws Error (kUsage) on an unknown task, camera or block.
Observability MeasureObservability(const ObservabilityRequest& request,
                                   const std::function<void(const ObservabilityRow&)>& on_row,
                                   const std::function<bool()>& stop);

// "front,side: object-grip 12.3 mm (of the mean alone 151.0 mm)"
std::string ToText(const ObservabilityRequest& request, const ObservabilityRow& row);
// Schema shoal-observability-1.
nlohmann::ordered_json ToJson(const Observability& observability);

}  // namespace shoal::launch

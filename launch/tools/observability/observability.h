// SPDX-License-Identifier: Apache-2.0
// `shoal env observability`: measures how well sets of cameras show a quantity of a task, as a
// basis for the choice of cameras.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "common/config/config.h"

namespace shoal::launch {

struct ObservabilityRequest {
  std::string task;
  // Sets of cameras to compare; empty: each camera of the task alone, and each pair.
  std::vector<std::vector<std::string>> cameras;
  std::vector<std::string> labels;  // in the form of sac.aux
  bool goal_hidden = false;         // true: hides the goal's marker, as in runs that relabel goals
  int width = 84, height = 84;
  std::string quality = "fast", encoder = "compact";
  int samples = 6000;
  int updates = 1500;
  int64_t seed = 1;
};

struct ObservabilityRow {
  std::vector<std::string> cameras;
  // One value per label, in the label's unit: root mean squared distance, over all numbers of the
  // label together. `error`: error of the network; `of_mean`: error if the mean is always
  // predicted.
  std::vector<double> error, of_mean;
};

struct Observability {
  ObservabilityRequest request;
  int trained = 0, held_out = 0;       // numbers of frames
  std::vector<ObservabilityRow> rows;  // in the order of the request
};

// `on_row` is called when a row is finished. `stop` is called often; if `stop` returns true, the
// measurement ends with the rows finished so far. Throws Error (kUsage) on an unknown task, camera
// or block.
Observability MeasureObservability(const ObservabilityRequest& request,
                                   const std::function<void(const ObservabilityRow&)>& on_row,
                                   const std::function<bool()>& stop);

// "front,side: object-grip 12.3 mm (of the mean alone 151.0 mm)"
std::string ToText(const ObservabilityRequest& request, const ObservabilityRow& row);
// Schema shoal-observability-1.
nlohmann::ordered_json ToJson(const Observability& observability);

}  // namespace shoal::launch

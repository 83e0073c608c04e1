// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/observability/observability.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/config/privileged_blocks.h"
#include "common/tasks/task_registry.h"
#include "launch/tools/observability/frame_regression.h"
#include "launch/tools/observability/labelled_frames.h"

namespace shoal::launch {
namespace {

constexpr double kMillimetres = 1000;

std::vector<std::vector<std::string>> CameraSets(const tasks::Task& task) {
  std::vector<std::string> names;
  for (const worlds::CameraView& view : worlds::MakeWorld(task.world(), {})->cameras()) {
    names.push_back(view.name);
  }
  std::vector<std::vector<std::string>> sets;
  for (const std::string& name : names) sets.push_back({name});
  for (size_t i = 0; i < names.size(); ++i) {
    for (size_t j = i + 1; j < names.size(); ++j) sets.push_back({names[i], names[j]});
  }
  return sets;
}

Config ConfigOf(const ObservabilityRequest& request, const std::vector<std::string>& cameras) {
  Config config;
  config.task = request.task;
  config.seed = request.seed;
  config.observation.cameras = cameras;
  config.observation.width = request.width;
  config.observation.height = request.height;
  config.observation.quality = request.quality;
  // Relabelled goals must be part of the policy's observation, and then the goal's marker is
  // hidden.
  if (request.goal_hidden) config.observation.goal_mode = "desired";
  if (request.goal_hidden) config.replay.hindsight = "future";
  config.sac.aux = request.labels;
  config.network.encoder = request.encoder;
  return config;
}

// Combines the errors of each label's numbers.
std::vector<double> ByLabel(const std::vector<double>& of_numbers, const PrivilegedBlocks& blocks) {
  std::vector<double> by_label;
  size_t at = 0;
  for (const AuxLabel& label : blocks.labels) {
    double squares = 0;
    for (int i = 0; i < label.size; ++i, ++at) squares += of_numbers[at] * of_numbers[at];
    by_label.push_back(std::sqrt(squares));
  }
  return by_label;
}

}  // namespace

Observability MeasureObservability(const ObservabilityRequest& request,
                                   const std::function<void(const ObservabilityRow&)>& on_row,
                                   const std::function<bool()>& stop) {
  const tasks::Task& task = tasks::FindTask(request.task);
  Observability result;
  result.request = request;
  if (result.request.cameras.empty()) result.request.cameras = CameraSets(task);
  for (const std::vector<std::string>& cameras : result.request.cameras) {
    const Config config = ConfigOf(request, cameras);
    const LabelledFrames frames = CollectLabelledFrames(config, request.samples);
    const RegressionErrors errors = RegressOnFrames(config, frames, request.updates, stop);
    if (stop()) break;
    const PrivilegedBlocks blocks = PrivilegedBlocksOf(config, frames.spec);
    result.trained = errors.trained;
    result.held_out = errors.held_out;
    result.rows.push_back({.cameras = cameras,
                           .error = ByLabel(errors.error, blocks),
                           .of_mean = ByLabel(errors.of_mean, blocks)});
    on_row(result.rows.back());
  }
  return result;
}

std::string ToText(const ObservabilityRequest& request, const ObservabilityRow& row) {
  std::string text;
  for (size_t i = 0; i < request.labels.size(); ++i) {
    text +=
        fmt::format("{}{} {:.1f} mm (the mean alone: {:.1f} mm)", i == 0 ? "" : ", ",
                    request.labels[i], row.error[i] * kMillimetres, row.of_mean[i] * kMillimetres);
  }
  return fmt::format("{:24} {}", fmt::format("{}", fmt::join(row.cameras, ",")), text);
}

nlohmann::ordered_json ToJson(const Observability& observability) {
  const ObservabilityRequest& request = observability.request;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ObservabilityRow& row : observability.rows) {
    rows.push_back({{"cameras", row.cameras}, {"error", row.error}, {"of_mean", row.of_mean}});
  }
  return {{"schema", "shoal-observability-1"},
          {"task", request.task},
          {"labels", request.labels},
          {"goal_hidden", request.goal_hidden},
          {"width", request.width},
          {"height", request.height},
          {"quality", request.quality},
          {"encoder", request.encoder},
          {"updates", request.updates},
          {"seed", request.seed},
          {"frames_trained", observability.trained},
          {"frames_held_out", observability.held_out},
          {"rows", rows}};
}

}  // namespace shoal::launch

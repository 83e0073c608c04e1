// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/minari_metadata.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

namespace shoal::launch {
namespace {

// The version of Minari's layout.
constexpr char kMinariVersion[] = "0.5.4";

// `value` as a nested list of this shape, because Gymnasium's spaces list a bound for each number.
std::string Filled(std::span<const int> shape, std::string_view value) {
  if (shape.empty()) return std::string(value);
  const std::string inner = Filled(shape.subspan(1), value);
  std::string list = "[";
  for (int i = 0; i < shape[0]; ++i) list += (i == 0 ? "" : ", ") + inner;
  return list + "]";
}

// Formatted by hand, because a bound may be Infinity, which Python reads but JSON lacks.
std::string Box(const std::vector<int>& shape, std::string_view type, std::string_view low,
                std::string_view high) {
  return fmt::format(R"({{"type": "Box", "dtype": "{}", "shape": {}, "low": {}, "high": {}}})",
                     type, nlohmann::json(shape).dump(), Filled(shape, low), Filled(shape, high));
}

std::string ObservationSpace(const ObservationSpec& spec) {
  std::string spaces;
  const auto add = [&](const std::string& name, const std::string& space) {
    spaces +=
        fmt::format("{}{}: {}", spaces.empty() ? "" : ", ", nlohmann::json(name).dump(), space);
  };
  for (const BlockSpec& block : spec.blocks) {
    add(block.name, Box({block.size}, "float32", "-Infinity", "Infinity"));
  }
  if (spec.HasPixels()) {
    add("pixels", Box({spec.channels, spec.height, spec.width}, "uint8", "0", "255"));
  }
  return fmt::format(R"({{"type": "Dict", "subspaces": {{{}}}}})", spaces);
}

// Minari's ids allow only letters, digits, - and _.
std::string DatasetId(std::string run) {
  const auto foreign = [](unsigned char c) { return std::isalnum(c) == 0 && c != '-' && c != '_'; };
  std::ranges::replace_if(run, foreign, '-');
  return fmt::format("shoal/{}-v0", run);
}

}  // namespace

std::string MinariMetadata(const ObservationSpec& spec, const MinariFacts& facts) {
  const nlohmann::ordered_json metadata = {
      {"dataset_id", DatasetId(facts.run)},
      {"minari_version", kMinariVersion},
      {"data_format", "hdf5"},
      {"jpeg_encoding", false},
      {"total_episodes", facts.episodes},
      {"total_steps", facts.steps},
      {"dataset_size", std::round(1e-5 * static_cast<double>(facts.bytes)) / 10},  // MB
      {"observation_space", ObservationSpace(spec)},
      {"action_space", Box({spec.action_size}, "float32", "-1.0", "1.0")},
      {"algorithm_name", facts.algorithm},
      {"description", fmt::format("Whole episodes of task {} out of the replay of Shoal's run {}.",
                                  spec.task, facts.run)},
  };
  return metadata.dump(1) + "\n";
}

}  // namespace shoal::launch

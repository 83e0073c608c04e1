// SPDX-License-Identifier: Apache-2.0
#include "common/spec/observation_spec.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"

namespace shoal {

using nlohmann::json;

namespace {

// The range of `name` among all blocks, or among the observed ones only.
std::optional<ObservationSpec::Range> Find(const std::vector<BlockSpec>& blocks,
                                           std::string_view name, bool observed_only) {
  int first = 0;
  for (const BlockSpec& block : blocks) {
    if (observed_only && !block.observed) continue;
    if (block.name == name) return ObservationSpec::Range{first, block.size};
    first += block.size;
  }
  return std::nullopt;
}

}  // namespace

int ObservationSpec::VectorSize() const {
  int size = 0;
  for (const BlockSpec& block : blocks) size += block.observed ? block.size : 0;
  return size;
}

int ObservationSpec::RecordedVectorSize() const {
  int size = 0;
  for (const BlockSpec& block : blocks) size += block.size;
  return size;
}

std::optional<ObservationSpec::Range> ObservationSpec::Recorded(std::string_view block) const {
  return Find(blocks, block, /*observed_only=*/false);
}

std::optional<ObservationSpec::Range> ObservationSpec::Observed(std::string_view block) const {
  return Find(blocks, block, /*observed_only=*/true);
}

uint64_t ObservationSpec::Hash() const {
  const std::string canonical = ToJson(*this).dump();
  return HashBytes(canonical.data(), canonical.size());
}

std::string ObservationSpec::Summary() const {
  std::string names;
  for (const std::string& camera : cameras) names += (names.empty() ? "" : ",") + camera;
  std::string seen;
  for (const BlockSpec& block : blocks) {
    if (block.observed) seen += (seen.empty() ? "" : ",") + block.name;
  }
  const std::string pixels =
      HasPixels() ? fmt::format("pixels {}x{}x{} [{}] stack {}{}, ", channels, height, width, names,
                                stack, goal_picture ? " + goal picture" : "")
                  : "";
  return fmt::format("{} {}vector {} [{}], action {}, model {}", task, pixels, VectorSize(), seen,
                     action_size, model_fingerprint);
}

json ToJson(const ObservationSpec& spec) {
  json blocks = json::array();
  for (const BlockSpec& block : spec.blocks) {
    blocks.push_back({{"name", block.name}, {"size", block.size}, {"observed", block.observed}});
  }
  json object{{"task", spec.task},
              {"cameras", spec.cameras},
              {"channels", spec.channels},
              {"height", spec.height},
              {"width", spec.width},
              {"stack", spec.stack},
              {"blocks", blocks},
              {"action_size", spec.action_size},
              {"drawn_actions", spec.drawn_actions},
              {"model_fingerprint", spec.model_fingerprint}};
  // Written only if present, so that specs without them keep the hash they had before.
  if (spec.goal_picture) object["goal_picture"] = true;
  if (!spec.environment.empty()) object["environment"] = ParseBoundedJson<json>(spec.environment);
  return object;
}

ObservationSpec ObservationSpecFromJson(const json& object) {
  ObservationSpec spec;
  try {
    object.at("task").get_to(spec.task);
    object.at("cameras").get_to(spec.cameras);
    object.at("channels").get_to(spec.channels);
    object.at("height").get_to(spec.height);
    object.at("width").get_to(spec.width);
    object.at("stack").get_to(spec.stack);
    if (object.contains("goal_picture")) object.at("goal_picture").get_to(spec.goal_picture);
    if (object.contains("environment")) spec.environment = object.at("environment").dump();
    for (const auto& block : object.at("blocks")) {
      spec.blocks.push_back({block.at("name").get<std::string>(), block.at("size").get<int>(),
                             block.at("observed").get<bool>()});
    }
    object.at("action_size").get_to(spec.action_size);
    object.at("drawn_actions").get_to(spec.drawn_actions);
    object.at("model_fingerprint").get_to(spec.model_fingerprint);
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("observation spec: {}", e.what());
  }
  return spec;
}

BlockPicker::BlockPicker(const ObservationSpec& spec,
                         const std::function<bool(const BlockSpec&)>& wanted)
    : recorded_size_(spec.RecordedVectorSize()) {
  int first = 0;
  for (const BlockSpec& block : spec.blocks) {
    if (wanted(block)) {
      // Adjacent blocks are copied as one range.
      if (!ranges_.empty() && ranges_.back().first + ranges_.back().size == first) {
        ranges_.back().size += block.size;
      } else {
        ranges_.push_back({first, block.size});
      }
      size_ += block.size;
    }
    first += block.size;
  }
}

BlockPicker BlockPicker::Observed(const ObservationSpec& spec) {
  return {spec, [](const BlockSpec& block) { return block.observed; }};
}

BlockPicker BlockPicker::Named(const ObservationSpec& spec, std::span<const std::string> names) {
  for (const std::string& name : names) CHECK(spec.Recorded(name)) << "no block '" << name << "'";
  return {spec, [&](const BlockSpec& block) {
            return std::ranges::find(names, block.name) != names.end();
          }};
}

void BlockPicker::Copy(std::span<const float> recorded, std::span<float> picked) const {
  CHECK(recorded.size() == size_t(recorded_size_) && picked.size() == size_t(size_))
      << recorded.size() << " to " << picked.size();
  auto to = picked.begin();
  for (const auto& [first, size] : ranges_) {
    to = std::ranges::copy(recorded.subspan(size_t(first), size_t(size)), to).out;
  }
}

}  // namespace shoal

#include "common/spec/observation_spec.h"

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/random.h"

namespace shoal {

using nlohmann::json;

int ObservationSpec::VectorSize() const {
  int size = 0;
  for (const BlockSpec& block : blocks) size += block.size;
  return size;
}

uint64_t ObservationSpec::Hash() const {
  const std::string canonical = ToJson(*this).dump();
  return HashBytes(canonical.data(), canonical.size());
}

std::string ObservationSpec::Summary() const {
  std::string names;
  for (const std::string& camera : cameras) names += (names.empty() ? "" : ",") + camera;
  return fmt::format("{} pixels {}x{}x{} [{}] stack {}, vector {}, action {}, model {}", task,
                     channels, height, width, names, stack, VectorSize(), action_size,
                     model_fingerprint);
}

json ToJson(const ObservationSpec& spec) {
  json blocks = json::array();
  for (const BlockSpec& block : spec.blocks) {
    blocks.push_back({{"name", block.name}, {"size", block.size}});
  }
  return {{"task", spec.task},
          {"cameras", spec.cameras},
          {"channels", spec.channels},
          {"height", spec.height},
          {"width", spec.width},
          {"stack", spec.stack},
          {"blocks", blocks},
          {"action_size", spec.action_size},
          {"model_fingerprint", spec.model_fingerprint}};
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
    for (const auto& block : object.at("blocks")) {
      spec.blocks.push_back({block.at("name").get<std::string>(), block.at("size").get<int>()});
    }
    object.at("action_size").get_to(spec.action_size);
    object.at("model_fingerprint").get_to(spec.model_fingerprint);
  } catch (const nlohmann::json::exception& e) {
    throw RuntimeError("observation spec: {}", e.what());
  }
  return spec;
}

}  // namespace shoal

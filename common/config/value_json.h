// SPDX-License-Identifier: Apache-2.0
// Values of keys that are more than a number, a text or a list, in JSON. Internal to common/config.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/bounded_json.h"
#include "common/config/config.h"

namespace shoal {

// Found by nlohmann's library, for json and ordered_json.
template <class Json>
void to_json(Json& out, const CustomCamera& camera) {
  out = Json{{"lookat", camera.lookat},
             {"distance", camera.distance},
             {"azimuth", camera.azimuth},
             {"elevation", camera.elevation}};
  if (!camera.body.empty()) out["body"] = camera.body;
}

template <class Json>
void to_json(Json& out, const StateBlocks& blocks) {
  if (blocks.names.empty()) {
    out = blocks.all;
  } else {
    out = blocks.names;
  }
}

template <class Json>
void to_json(Json& out, const KeywordArguments& arguments) {
  out = ParseBoundedJson<Json>(arguments.json);
}

namespace internal {

// true, false, or a list of at least one name, each once. False when it is none of these.
bool ReadStateBlocks(const nlohmann::json& value, StateBlocks* blocks);

// An object of cameras by name. False when it is none, a name is empty, one of the four numbers is
// missing, ill-typed or out of range, `body` is there and no name, or there is another key.
bool ReadCustomCameras(const nlohmann::json& value, std::map<std::string, CustomCamera>* cameras);

}  // namespace internal
}  // namespace shoal

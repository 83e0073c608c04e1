// SPDX-License-Identifier: Apache-2.0
// Converts values of compound types (cameras, blocks, arguments) to and from JSON. Internal to
// common/config.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "common/base/bounded_json.h"
#include "common/config/config.h"

namespace shoal {

// nlohmann's library finds the to_json functions, for json and ordered_json.
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

// Reads true, false, or a list of at least one name without duplicates. Returns false for any other
// value.
bool ReadStateBlocks(const nlohmann::json& value, StateBlocks* blocks);

// Reads an object of cameras by name. Returns false if the value is not an object, a name is empty,
// a number is missing, ill-typed or out of range, `body` is not a name, or a key is unknown.
bool ReadCustomCameras(const nlohmann::json& value, std::map<std::string, CustomCamera>* cameras);

}  // namespace internal
}  // namespace shoal

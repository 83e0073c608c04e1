// SPDX-License-Identifier: Apache-2.0
// Fields in files of runs that may be missing or null, or written by an older build.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace shoal::launch {

inline std::optional<double> NumberOrNothing(const nlohmann::json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

inline std::string TextOrEmpty(const nlohmann::json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() && it->is_string() ? it->get<std::string>() : "";
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Readers of fields that may be missing or null in a run's files, for example because an older
// build wrote the file.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace shoal::launch {

inline std::optional<double> NumberOrNothing(const nlohmann::json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

inline std::optional<double> NumberOrNothing(const nlohmann::json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() ? NumberOrNothing(*it) : std::nullopt;
}

inline std::string TextOrEmpty(const nlohmann::json& object, const char* key) {
  const auto it = object.find(key);
  return it != object.end() && it->is_string() ? it->get<std::string>() : "";
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// An optional value in JSON: the value, or null.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace shoal {

template <class T>
nlohmann::ordered_json OrNull(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

}  // namespace shoal

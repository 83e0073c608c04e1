// SPDX-License-Identifier: Apache-2.0
#include "common/config/nearest_key.h"

#include "common/base/nearest_name.h"
#include "common/config/config_keys.h"

namespace shoal::internal {

std::string NearestKey(std::string_view path) {
  std::string_view best;
  int best_distance = static_cast<int>(path.size() / 2) + 1;
  const auto offer = [&](std::string_view spelled, std::string_view name) {
    const int distance = EditDistance(path, spelled);
    if (distance < best_distance) {
      best_distance = distance;
      best = name;
    }
  };
  const bool bare = path.find('.') == std::string_view::npos;
  for (const Key& key : Keys()) {
    offer(key.path, key.path);
    const size_t dot = key.path.find('.');
    if (dot == std::string_view::npos || !bare) continue;
    offer(key.path.substr(0, dot), key.path.substr(0, dot));
    offer(key.path.substr(dot + 1), key.path);
  }
  return std::string(best);
}

}  // namespace shoal::internal

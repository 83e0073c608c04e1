#include "common/config/nearest_key.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "common/config/config_keys.h"

namespace shoal::internal {

int EditDistance(std::string_view a, std::string_view b) {
  // row[j]: distance of the first i characters of a to the first j of b.
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (size_t i = 1; i <= a.size(); ++i) {
    int diagonal = row[0];
    row[0] = static_cast<int>(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const int replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

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

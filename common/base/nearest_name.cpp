// SPDX-License-Identifier: Apache-2.0
#include "common/base/nearest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace shoal {

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

std::string NearestName(std::string_view word, std::span<const std::string> names) {
  const auto distance = [&](const std::string& name) { return EditDistance(word, name); };
  const auto nearest = std::ranges::min_element(names, {}, distance);
  if (nearest == names.end() || distance(*nearest) > static_cast<int>(word.size() / 2)) return "";
  return *nearest;
}

std::string NearestHint(std::string_view word, std::span<const std::string> names) {
  const std::string nearest = NearestName(word, names);
  return nearest.empty() ? "" : fmt::format("; nearest is '{}'", nearest);
}

}  // namespace shoal

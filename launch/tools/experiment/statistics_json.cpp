// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/statistics_json.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <vector>

#include "common/base/or_null.h"

namespace shoal::launch {

using nlohmann::ordered_json;

ordered_json IntervalJson(const std::optional<Interval>& interval) {
  return interval ? ordered_json{interval->low, interval->high} : ordered_json(nullptr);
}

ordered_json RatioJson(const std::string& name, const SampleRatio& ratio) {
  ordered_json pairs = ordered_json::array();
  for (const RatioPair& pair : ratio.pairs) {
    pairs.push_back({{"seed", pair.seed},
                     {"n", OrNull(pair.n)},
                     {"n_reference", OrNull(pair.reference)},
                     {"ratio", OrNull(pair.Ratio())}});
  }
  return {{"name", name},
          {"pairs", pairs},
          {"not_reached", ratio.not_reached},
          {"median", OrNull(ratio.median)}};
}

std::string FormatMedian(const SampleRatio& ratio) {
  if (ratio.pairs.empty()) return "no seed is done in both";
  const std::string pairs =
      fmt::format("{} pair{}", ratio.pairs.size(), ratio.pairs.size() == 1 ? "" : "s");
  if (!ratio.median) {
    return fmt::format("no median: {} of {} did not reach the target", ratio.not_reached, pairs);
  }
  const std::string missed =
      ratio.not_reached > 0 ? fmt::format(", {} not reached", ratio.not_reached) : "";
  return fmt::format("median {:.2f} of {}{}", *ratio.median, pairs, missed);
}

std::string FormatPairs(const SampleRatio& ratio, const std::string& arm,
                        const std::string& reference) {
  std::vector<std::string> words;
  for (const RatioPair& pair : ratio.pairs) {
    const auto value = pair.Ratio();
    const std::string& missing = pair.n ? reference : pair.reference ? arm : "either";
    words.push_back(fmt::format(
        "seed {}: {}", pair.seed,
        value ? fmt::format("{:.2f}", *value) : fmt::format("not reached by {}", missing)));
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/experiment/statistics_json.h"

#include <fmt/core.h>

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

std::string FormatPooled(uint64_t successes, uint64_t episodes) {
  if (episodes == 0) return "-";
  const Interval interval = Wilson95(successes, episodes);
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}] ({}/{})",
                     100 * static_cast<double>(successes) / static_cast<double>(episodes),
                     100 * interval.low, 100 * interval.high, successes, episodes);
}

std::string FormatMean(const std::vector<double>& values, int digits) {
  if (values.empty()) return "-";
  const auto interval = MeanInterval95(values);
  const std::string mean = fmt::format("{:.{}f}", Mean(values), digits);
  if (!interval) return mean + " (1 seed)";
  return fmt::format("{} [{:.{}f}, {:.{}f}] ({} seeds)", mean, interval->low, digits,
                     interval->high, digits, values.size());
}

std::string FormatDistances(std::vector<double> metres) {
  for (double& distance : metres) distance = Centimetres(distance);
  return FormatMean(metres, 2);
}

}  // namespace shoal::launch

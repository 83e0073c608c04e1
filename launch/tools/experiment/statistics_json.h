// SPDX-License-Identifier: Apache-2.0
// Intervals and ratios as JSON and as text of summaries and comparisons.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "launch/tools/experiment/statistics.h"

namespace shoal::launch {

// [low, high], or null.
nlohmann::ordered_json IntervalJson(const std::optional<Interval>& interval);
// {name, pairs: [{seed, n, n_reference, ratio}], not_reached, median}.
nlohmann::ordered_json RatioJson(const std::string& name, const SampleRatio& ratio);

// "median 1.50 of 3 pairs, 1 not reached", or the reason why there is no median. A pair is a seed
// that both arms have.
std::string FormatMedian(const SampleRatio& ratio);
// The ratio of each pair, with the arms' names: "seed 31: 1.50, seed 32: not reached by faster,
// seed 33: 1.33".
std::string FormatPairs(const SampleRatio& ratio, const std::string& arm,
                        const std::string& reference);

// Distances are in metres in files and programs, and in centimetres in texts.
constexpr double Centimetres(double metres) { return 100 * metres; }

}  // namespace shoal::launch

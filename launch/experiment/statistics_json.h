// SPDX-License-Identifier: Apache-2.0
// Intervals and ratios as summaries and comparisons write and say them.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/experiment/statistics.h"

namespace shoal::launch {

// [low, high], or null.
nlohmann::ordered_json IntervalJson(const std::optional<Interval>& interval);
// {name, pairs: [{seed, n, n_reference, ratio}], not_reached, median}.
nlohmann::ordered_json RatioJson(const std::string& name, const SampleRatio& ratio);

// "97.3 % [94.1, 98.9] (292/300)"; "-" without episodes.
std::string FormatPooled(uint64_t successes, uint64_t episodes);
// "-0.82 [-0.91, -0.73] (3 seeds)"; the mean alone of one seed; "-" without any.
std::string FormatMean(const std::vector<double>& values, int digits);
// The same of distances in metres, said in centimetres.
std::string FormatDistances(std::vector<double> metres);

// Distances are metres in files and programs, centimetres for people.
constexpr double Centimetres(double metres) { return 100 * metres; }

}  // namespace shoal::launch

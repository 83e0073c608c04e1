// SPDX-License-Identifier: Apache-2.0
// Results of one method over its seeds, with intervals, and the form of these results in summaries,
// comparisons and reports. The unit of the statistics is the seed (statistics.h).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/statistics.h"

namespace shoal::launch {

struct SeedFigures {
  std::vector<SeedSuccess> successes{};        // of each seed; empty if the task has no success
  std::vector<double> returns{}, distances{};  // means of each seed; distances in m
  // Number of seeds whose run failed (numbers that were not finite, a process that died). The
  // vectors exclude these seeds; every line and object states their number.
  size_t failed = 0;

  // Adds the result of one seed.
  void Add(std::optional<double> success, size_t episodes, double return_mean,
           std::optional<double> distance);

  uint64_t Successes() const;
  uint64_t Episodes() const;
  std::vector<double> Rates() const;
  // Mean of the seeds' rates, with 0 for each failed seed; empty without seeds or without success.
  std::optional<double> RateWithFailedAsZero() const;
};

// {pooled, episodes, mean, seeds, ci95, wilson95, failed, mean_with_failed_as_0}: `mean` and `ci95`
// are over seeds; `wilson95` is the interval of the policy's success rate if there is one seed,
// else null.
nlohmann::ordered_json SuccessJson(const SeedFigures& figures);
// {mean, ci95, seeds, failed}.
nlohmann::ordered_json ReturnJson(const SeedFigures& figures);
nlohmann::ordered_json DistanceJson(const SeedFigures& figures);

// One seed: "97.3 % [94.1, 98.9] (292/300)". Several seeds: "96.5 % [89.0, 100.0] (3 seeds,
// 1158/1200)". With a failed seed: "(2 seeds, 792/800; 1 failed: 66.0 % with it as 0)". Without
// results: "-".
std::string FormatSuccess(const SeedFigures& figures);
// "-0.82 [-0.91, -0.73] (3 seeds)"; "-0.82 (1 seed)"; "(2 seeds; 1 failed, left out)". The number
// of digits follows from the width of the interval.
std::string FormatReturn(const SeedFigures& figures);
// One number with four significant digits, at most two of them after the point, without zeros at
// the end: "688.3", "42".
std::string FormatValue(double value);
// Formats distances like returns, in centimetres.
std::string FormatDistance(const SeedFigures& figures);

// Interval of the mean distance, m; not below 0.
std::optional<Interval> DistanceInterval95(const std::vector<double>& distances);

}  // namespace shoal::launch

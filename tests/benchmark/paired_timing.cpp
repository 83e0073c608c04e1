// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/paired_timing.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/interrupted.h"
#include "common/base/stop.h"

namespace shoal::bench {
namespace {

double CallsPerSecond(const std::function<void()>& act, double seconds) {
  const SteadyTime start = Now();
  int calls = 0;
  do {
    if (StopRequested()) throw Interrupted("not every row was measured");
    act();
    ++calls;
  } while (SecondsSince(start) < seconds);
  return calls / SecondsSince(start);
}

}  // namespace

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

Row TimePair(const Pairing& pairing, int repetitions, double seconds) {
  const std::shared_ptr<void> held = pairing.meanwhile ? pairing.meanwhile() : nullptr;
  pairing.ours();
  if (pairing.other) pairing.other();
  const double units = pairing.units ? pairing.units() : pairing.units_per_call;
  std::vector<double> ours, other, ratios;
  for (int i = 0; i < repetitions; ++i) {
    ours.push_back(CallsPerSecond(pairing.ours, seconds));
    other.push_back(pairing.other ? CallsPerSecond(pairing.other, seconds)
                                  : pairing.other_rate / units);
    ratios.push_back(ours.back() / other.back());
  }
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  Row row;
  row.stage = pairing.stage;
  row.unit = pairing.unit;
  row.against = pairing.against;
  row.figure = Median(ours) * units;
  row.against_figure = Median(other) * units;
  row.ratio = Median(ratios);
  row.spread = (*most - *least) / row.ratio;
  row.target = pairing.target;
  row.repetitions = repetitions;
  return row;
}

nlohmann::ordered_json ToJson(const Row& row) {
  return {{"stage", row.stage},
          {"figure", row.figure},
          {"unit", row.unit},
          {"against", row.against},
          {"against_figure", row.against_figure},
          {"ratio", row.ratio},
          {"target", row.target > 0 ? nlohmann::ordered_json(row.target) : nullptr},
          {"repetitions", row.repetitions},
          {"spread", row.spread}};
}

std::string LineOf(const Row& row) {
  std::string line =
      fmt::format("{}: {:.4g} {}, {:.2f} x {} ({:.4g}), spread {:.2f}", row.stage, row.figure,
                  row.unit, row.ratio, row.against, row.against_figure, row.spread);
  if (row.target > 0) {
    line += fmt::format(", target {:.2f}{}", row.target, row.ratio < row.target ? " missed" : "");
  }
  return line;
}

}  // namespace shoal::bench

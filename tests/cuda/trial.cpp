// SPDX-License-Identifier: Apache-2.0
#include "tests/cuda/trial.h"

#include <limits>
#include <utility>

#include "common/base/error.h"

namespace shoal::trial {

Trials::Trials(std::string only, Show show) : only_(std::move(only)), show_(std::move(show)) {}

void Trials::TryError(const std::string& name, const std::string& unit, double limit,
                      const std::function<double()>& error) const {
  Try({.trial = name, .unit = unit, .limit = limit}, error, /*at_most=*/true);
}

void Trials::TryRate(const std::string& name, const std::string& unit, std::optional<double> limit,
                     const std::function<double()>& rate) const {
  Try({.trial = name, .unit = unit, .limit = limit}, rate, /*at_most=*/false);
}

void Trials::Try(Row row, const std::function<double()>& figure, bool at_most) const {
  if (row.trial.find(only_) == std::string::npos) return;
  try {
    row.figure = figure();
    row.passed = !row.limit || (at_most ? row.figure <= *row.limit : row.figure >= *row.limit);
  } catch (const Error& error) {
    row.figure = std::numeric_limits<double>::quiet_NaN();
    row.fault = error.what();
    row.passed = false;
  }
  show_(row);
}

}  // namespace shoal::trial

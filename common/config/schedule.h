// SPDX-License-Identifier: Apache-2.0
// A number that may change during a run. A schedule is constant, or linear from `start` at 0 env
// steps of the run to `end` at `env_steps` and equal to `end` afterwards.
//
// In a configuration, a schedule is a JSON number or the text "linear(START,END,ENV_STEPS)".
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace shoal {

struct Schedule {
  double start = 0, end = 0;
  int64_t env_steps = 0;  // 0 = constant, with `start` equal to `end`

  static Schedule Constant(double value) { return {value, value, 0}; }
  bool constant() const { return env_steps == 0; }
  double At(uint64_t run_env_steps) const;
  // The smallest and the largest value of the schedule.
  double Least() const { return std::min(start, end); }
  double Most() const { return std::max(start, end); }

  // Mean over the env steps from `from` to `to` >= `from`; At(from) if `from` = `to`:
  //
  //   mean = integral of At(x) dx from `from` to `to`  /  (to - from)
  //        = ((t - f) (At(f) + At(t)) / 2  +  (to - from - (t - f)) end) / (to - from)
  //   f = min(from, env_steps),  t = min(to, env_steps)
  //
  // The mean of a constant is exactly `start`; other means are exact except for rounding.
  double Mean(uint64_t from, uint64_t to) const;
  // The integral, Mean * (to - from). If the schedule is a number per env step, this is the total
  // for these steps.
  double Integral(uint64_t from, uint64_t to) const {
    return Mean(from, to) * static_cast<double>(to - from);
  }

  bool operator==(const Schedule&) const = default;
};

// Accepts numbers in JSON's spelling, blanks only after commas, and 1 <= ENV_STEPS <= 10^12.
// Returns empty for any other text.
std::optional<Schedule> ParseSchedule(std::string_view text);
// Inverse of ParseSchedule. CHECKs that the schedule is not constant.
std::string ScheduleText(const Schedule& schedule);

// Writes a constant as a number and other schedules as text. nlohmann's library finds this
// function, for json and ordered_json.
template <class Json>
void to_json(Json& out, const Schedule& schedule) {
  out = schedule.constant() ? Json(schedule.start) : Json(ScheduleText(schedule));
}

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
#include "common/config/schedule.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

#include "common/base/check.h"

namespace shoal {
namespace {

constexpr std::string_view kLinear = "linear(";
constexpr int64_t kMostEnvSteps = 1'000'000'000'000;

// Removes a number from the front of the text. False if there is none.
template <class Number>
bool TakeNumber(std::string_view* text, Number* number) {
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), *number);
  if (error != std::errc()) return false;
  text->remove_prefix(static_cast<size_t>(end - text->data()));
  return true;
}

// Removes a comma and the blanks behind it from the front.
bool TakeComma(std::string_view* text) {
  if (!text->starts_with(',')) return false;
  text->remove_prefix(1);
  while (text->starts_with(' ')) text->remove_prefix(1);
  return true;
}

}  // namespace

double Schedule::At(uint64_t run_env_steps) const {
  if (constant()) return start;
  if (run_env_steps >= static_cast<uint64_t>(env_steps)) return end;
  const double part = static_cast<double>(run_env_steps) / static_cast<double>(env_steps);
  return start + part * (end - start);
}

double Schedule::Mean(uint64_t from, uint64_t to) const {
  CHECK(from <= to) << from << " " << to;
  if (constant()) return start;
  if (from == to) return At(from);
  const auto bend = static_cast<uint64_t>(env_steps);
  const uint64_t f = std::min(from, bend), t = std::min(to, bend);
  const auto line = static_cast<double>(t - f), flat = static_cast<double>(to - from - (t - f));
  return (line * (At(f) + At(t)) / 2 + flat * end) / (line + flat);
}

std::optional<Schedule> ParseSchedule(std::string_view text) {
  if (!text.starts_with(kLinear)) return std::nullopt;
  text.remove_prefix(kLinear.size());
  Schedule schedule;
  if (!TakeNumber(&text, &schedule.start) || !TakeComma(&text) ||
      !TakeNumber(&text, &schedule.end) || !TakeComma(&text) ||
      !TakeNumber(&text, &schedule.env_steps) || text != ")") {
    return std::nullopt;
  }
  // from_chars accepts "nan" and "inf", which JSON does not have.
  if (!std::isfinite(schedule.start) || !std::isfinite(schedule.end)) return std::nullopt;
  if (schedule.env_steps < 1 || schedule.env_steps > kMostEnvSteps) return std::nullopt;
  return schedule;
}

std::string ScheduleText(const Schedule& schedule) {
  CHECK(!schedule.constant());
  return fmt::format("{}{},{},{})", kLinear, schedule.start, schedule.end, schedule.env_steps);
}

}  // namespace shoal

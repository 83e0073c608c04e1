// SPDX-License-Identifier: Apache-2.0
#include "common/config/key_value.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "common/config/value_json.h"

namespace shoal::internal {
namespace {

using nlohmann::json;
using Intervals = std::map<std::string, std::array<double, 2>>;

bool IsFileName(const std::string& text) {
  const auto allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
  };
  return !text.empty() && text.size() <= kLongestFileName && text[0] != '.' && text[0] != '-' &&
         std::ranges::all_of(text, allowed);
}

// Whether the rule allows a value that has the right type.
bool Allows(const Rule& rule, int64_t value) {
  const auto* range = std::get_if<IntegerRange>(&rule);
  return range == nullptr || (value >= range->low && value <= range->high);
}

bool Allows(const Rule& rule, double value) {
  const auto* range = std::get_if<RealRange>(&rule);
  if (range == nullptr) return true;
  return (range->low_open ? value > range->low : value >= range->low) &&
         (range->high_open ? value < range->high : value <= range->high);
}

bool Allows(const Rule& rule, const std::string& value) {
  if (const auto* choices = std::get_if<Choices>(&rule)) {
    return std::ranges::find(choices->words, value) != choices->words.end();
  }
  if (const auto* name = std::get_if<FileName>(&rule)) {
    return IsFileName(value) || (name->optional && value.empty());
  }
  return true;
}

// Takes 1e5 as an integer, too. Beyond 2^53 a real number represents several integers.
json AsInteger(const json& value) {
  if (!value.is_number_float()) return value;
  const double number = value.get<double>();
  constexpr double kExact = 9007199254740992;
  if (std::abs(number) > kExact || number != std::trunc(number)) return value;
  return static_cast<int64_t>(number);
}

// Each overload of Read takes one JSON value as one type of member.
bool Read(const json& value, const Rule&, bool* out) {
  if (!value.is_boolean()) return false;
  *out = value.get<bool>();
  return true;
}

template <std::integral T>
bool Read(const json& value, const Rule& rule, T* out) {
  const json integer = AsInteger(value);
  if (!integer.is_number_integer()) return false;
  // Without this check, get<int64_t>() would wrap around.
  const bool too_large =
      integer.is_number_unsigned() &&
      integer.get<uint64_t>() > static_cast<uint64_t>(std::numeric_limits<int64_t>::max());
  if (too_large || !Allows(rule, integer.get<int64_t>())) return false;
  *out = static_cast<T>(integer.get<int64_t>());
  return true;
}

bool Read(const json& value, const Rule& rule, double* out) {
  if (!value.is_number() || !Allows(rule, value.get<double>())) return false;
  *out = value.get<double>();
  return true;
}

bool Read(const json& value, const Rule& rule, std::string* out) {
  if (!value.is_string() || !Allows(rule, value.get_ref<const std::string&>())) return false;
  *out = value.get<std::string>();
  return true;
}

bool Read(const json& value, const Rule&, StateBlocks* out) { return ReadStateBlocks(value, out); }

bool Read(const json& value, const Rule&, KeywordArguments* out) {
  if (!value.is_object()) return false;
  out->json = value.dump();
  return true;
}

bool Read(const json& value, const Rule& rule, Schedule* out) {
  double constant = 0;
  if (Read(value, rule, &constant)) {
    *out = Schedule::Constant(constant);
    return true;
  }
  if (!value.is_string()) return false;
  const auto schedule = ParseSchedule(value.get_ref<const std::string&>());
  if (!schedule || !Allows(rule, schedule->start) || !Allows(rule, schedule->end)) return false;
  *out = *schedule;
  return true;
}

bool Read(const json& value, const Rule& rule, Intervals* out) {
  if (!value.is_object()) return false;
  Intervals intervals;
  for (const auto& [name, bounds] : value.items()) {
    if (!bounds.is_array() || bounds.size() != 2) return false;
    auto& [low, high] = intervals[name];
    if (!Read(bounds[0], rule, &low) || !Read(bounds[1], rule, &high) || low > high) return false;
  }
  *out = std::move(intervals);
  return true;
}

bool Read(const json& value, const Rule&, std::map<std::string, CustomCamera>* out) {
  return ReadCustomCameras(value, out);
}

template <class T>
bool Read(const json& value, const Rule& rule, std::vector<T>* out) {
  if (!value.is_array()) return false;
  std::vector<T> list;
  for (const json& element : value) {
    T item{};
    if (!Read(element, rule, &item)) return false;
    list.push_back(item);
  }
  *out = std::move(list);
  return true;
}

}  // namespace

bool AssignValue(const Key& key, const json& value, Config* config) {
  return std::visit([&](auto* member) { return Read(value, key.rule, member); }, key.slot(*config));
}

}  // namespace shoal::internal

// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/json_members.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <limits>

#include "common/base/error.h"

namespace shoal::launch {

using nlohmann::ordered_json;

std::optional<int64_t> NaturalNumber(const ordered_json& value) {
  // Parsed text has another number type than values made in C++.
  if (!value.is_number_integer()) return std::nullopt;
  if (value.is_number_unsigned() &&
      value.get<uint64_t>() > static_cast<uint64_t>(std::numeric_limits<int64_t>::max())) {
    return std::nullopt;
  }
  const auto number = value.get<int64_t>();
  return number >= 0 ? std::optional(number) : std::nullopt;
}

std::optional<std::vector<int64_t>> IncreasingNumbers(const ordered_json& value) {
  if (!value.is_array() || value.empty()) return std::nullopt;
  std::vector<int64_t> numbers;
  for (const ordered_json& element : value) {
    const auto number = NaturalNumber(element);
    if (!number || *number <= (numbers.empty() ? 0 : numbers.back())) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

bool IsFileName(const std::string& text) {
  const auto allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' || c == '-';
  };
  return !text.empty() && text[0] != '.' && text[0] != '-' && std::ranges::all_of(text, allowed);
}

JsonMembers::JsonMembers(const ordered_json& object, std::string source)
    : object_(object), source_(std::move(source)) {
  if (!object.is_object()) throw UsageError("{}: expected a JSON object", source_);
}

void JsonMembers::NeedSchema(const char* schema) {
  if (Text("schema", "") != schema) {
    throw UsageError("{}: expected an object of schema '{}'", source_, schema);
  }
}

const ordered_json* JsonMembers::Find(const std::string& name) {
  known_.push_back(name);
  const auto it = object_.find(name);
  return it == object_.end() ? nullptr : &*it;
}

const ordered_json& JsonMembers::Need(const std::string& name) {
  if (const ordered_json* value = Find(name)) return *value;
  throw UsageError("{}: '{}' is missing", source_, name);
}

std::string JsonMembers::Text(const std::string& name, const std::string& absent) {
  const ordered_json* value = Find(name);
  if (value == nullptr) return absent;
  if (!value->is_string()) Refuse(name, *value, "a string");
  return value->get<std::string>();
}

std::string JsonMembers::NeedText(const std::string& name) {
  const ordered_json& value = Need(name);
  if (!value.is_string() || value.get<std::string>().empty()) {
    Refuse(name, value, "a string that is not empty");
  }
  return value.get<std::string>();
}

void JsonMembers::Refuse(const std::string& name, const ordered_json& value,
                         const char* expected) const {
  throw UsageError("{}: {} = {}: expected {}", source_, name, value.dump(), expected);
}

void JsonMembers::RefuseOthers() const {
  for (const auto& [name, value] : object_.items()) {
    if (std::ranges::find(known_, name) == known_.end()) {
      throw UsageError("{}: unknown member '{}', there are: {}", source_, name,
                       fmt::join(known_, ", "));
    }
  }
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Strict reader of the members of a JSON object, for files that users write.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

// An integer from 0 to the largest int64; empty for any other value.
std::optional<int64_t> NaturalNumber(const nlohmann::ordered_json& value);

// A list of one or more increasing integers of at least 1; empty for any other value.
std::optional<std::vector<int64_t>> IncreasingNumbers(const nlohmann::ordered_json& value);

// Letters, digits, '.', '_' and '-', the first of which is neither '.' nor '-'.
bool IsFileName(const std::string& text);

// Reads the members of one object and refuses members that no call has asked for. All functions
// throw Error (usage), in one line that names `source` and the member. Borrows the object.
class JsonMembers {
 public:
  // Throws if `object` is not a JSON object.
  JsonMembers(const nlohmann::ordered_json& object, std::string source);

  const std::string& source() const { return source_; }

  // Throws if the member `schema` is missing or has another value.
  void NeedSchema(const char* schema);
  // Null if the object does not have the member.
  const nlohmann::ordered_json* Find(const std::string& name);
  // Throws if the member is missing.
  const nlohmann::ordered_json& Need(const std::string& name);
  // `absent` if the object does not have the member. Throws if the member is not a string.
  std::string Text(const std::string& name, const std::string& absent);
  // Throws if the member is missing, or is not a string of at least one character.
  std::string NeedText(const std::string& name);

  // Throws the error for an ill-typed member: "SOURCE: NAME = VALUE: expected EXPECTED".
  [[noreturn]] void Refuse(const std::string& name, const nlohmann::ordered_json& value,
                           const char* expected) const;
  // Throws if the object has a member that no call has named. Call it last.
  void RefuseOthers() const;

 private:
  const nlohmann::ordered_json& object_;
  const std::string source_;
  std::vector<std::string> known_;
};

}  // namespace shoal::launch

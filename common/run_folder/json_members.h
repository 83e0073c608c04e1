// SPDX-License-Identifier: Apache-2.0
// Reads members of a JSON object of a run's file. If a member is missing or has another type,
// throws Error naming the file and the member:
// "'eval/final.json': 'aggregate.return_mean': expected a number".
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "common/base/bounded_json.h"
#include "common/base/error.h"

namespace shoal {

// Parses an object of this schema. `file` names the text in errors.
inline nlohmann::ordered_json ParseSchemaObject(const std::string& text, const std::string& file,
                                                const char* schema) {
  auto object = ParseBoundedJson<nlohmann::ordered_json>(text);
  if (!object.is_object() || !object.contains("schema") || object["schema"] != schema) {
    throw RuntimeError("{}: expected an object of schema '{}'", file, schema);
  }
  return object;
}

// Borrows the object. The functions "...IfAny" return empty if the member is absent or null.
class JsonMembers {
 public:
  // `path`: the object's place in the file: "" for the whole file, or for example "aggregate.".
  JsonMembers(const nlohmann::ordered_json& object, std::string file, std::string path = "")
      : object_(object), file_(std::move(file)), path_(std::move(path)) {
    if (!object.is_object()) {
      throw RuntimeError("{}: '{}': expected an object", file_, path_.substr(0, path_.size() - 1));
    }
  }

  const nlohmann::ordered_json& At(const char* key) const {
    const auto it = object_.find(key);
    if (it == object_.end()) throw RuntimeError("{}: no '{}{}'", file_, path_, key);
    return *it;
  }
  bool Has(const char* key) const {
    const auto it = object_.find(key);
    return it != object_.end() && !it->is_null();
  }
  JsonMembers Object(const char* key) const { return {At(key), file_, path_ + key + "."}; }
  const nlohmann::ordered_json& List(const char* key) const {
    return Checked(key, At(key).is_array(), "a list");
  }
  // The object at index `place` of a list.
  JsonMembers ObjectOf(const char* list, size_t place) const {
    return {List(list).at(place), file_, fmt::format("{}{}[{}].", path_, list, place)};
  }

  uint64_t Count(const char* key) const {
    return Checked(key, At(key).is_number_unsigned(), "a count").get<uint64_t>();
  }
  double Number(const char* key) const {
    return Checked(key, At(key).is_number(), "a number").get<double>();
  }
  std::string Text(const char* key) const {
    return Checked(key, At(key).is_string(), "a text").get<std::string>();
  }
  bool Flag(const char* key) const {
    return Checked(key, At(key).is_boolean(), "true or false").get<bool>();
  }
  std::optional<double> NumberIfAny(const char* key) const {
    return Has(key) ? std::optional(Number(key)) : std::nullopt;
  }
  std::optional<std::string> TextIfAny(const char* key) const {
    return Has(key) ? std::optional(Text(key)) : std::nullopt;
  }

  [[noreturn]] void Refuse(const char* key, const std::string& why) const {
    throw RuntimeError("{}: '{}{}': {}", file_, path_, key, why);
  }

 private:
  const nlohmann::ordered_json& Checked(const char* key, bool fits, const char* expected) const {
    if (!fits) Refuse(key, fmt::format("expected {}", expected));
    return object_.find(key).value();
  }

  const nlohmann::ordered_json& object_;
  const std::string file_, path_;
};

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// Validates a JSON value against a JSON Schema. Supports only the keywords that ConfigSchema uses.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>

namespace shoal {

class SchemaCheck {
 public:
  // The first fault as "PATH: KEYWORD"; empty if there is no fault. Fails the test on an unknown
  // keyword, so that no keyword is ignored.
  static std::string Fault(const nlohmann::json& value, const nlohmann::json& schema,
                           const std::string& path = "") {
    for (const auto& [keyword, argument] : schema.items()) {
      const std::string inside = KeywordFault(value, schema, keyword, argument, path);
      if (!inside.empty()) return inside;
    }
    return "";
  }

 private:
  using json = nlohmann::json;

  static bool HasType(const json& value, const std::string& type) {
    if (type == "integer") {
      return value.is_number_integer() ||
             (value.is_number_float() && value.get<double>() == std::trunc(value.get<double>()));
    }
    if (type == "number") return value.is_number();
    return type == value.type_name();
  }

  static std::string MembersFault(const json& value, const json& schema, const std::string& path) {
    static const json kNone = json::object();
    const json& known = schema.contains("properties") ? schema["properties"] : kNone;
    for (const auto& [name, member] : value.items()) {
      const std::string at = path + "/" + name;
      if (known.contains(name)) {
        const std::string fault = Fault(member, known[name], at);
        if (!fault.empty()) return fault;
      } else if (schema.contains("additionalProperties")) {
        const json& others = schema["additionalProperties"];
        if (others == false) return at + ": additionalProperties";
        const std::string fault = Fault(member, others, at);
        if (!fault.empty()) return fault;
      }
    }
    return "";
  }

  static std::string ElementsFault(const json& value, const json& schema, const std::string& path) {
    for (size_t i = 0; i < value.size(); ++i) {
      const std::string fault = Fault(value[i], schema, path + "/" + std::to_string(i));
      if (!fault.empty()) return fault;
    }
    return "";
  }

  static bool Keeps(const json& value, const std::string& keyword, const json& argument) {
    if (keyword == "type") return HasType(value, argument);
    if (keyword == "const") return value == argument;
    if (keyword == "enum") return std::ranges::find(argument, value) != argument.end();
    if (keyword == "minimum") return !value.is_number() || value >= argument;
    if (keyword == "maximum") return !value.is_number() || value <= argument;
    if (keyword == "exclusiveMinimum") return !value.is_number() || value > argument;
    if (keyword == "exclusiveMaximum") return !value.is_number() || value < argument;
    if (keyword == "minItems") return !value.is_array() || value.size() >= argument;
    if (keyword == "maxItems") return !value.is_array() || value.size() <= argument;
    if (keyword == "uniqueItems") {
      return !value.is_array() || std::set<json>(value.begin(), value.end()).size() == value.size();
    }
    if (keyword == "minLength") {
      return !value.is_string() || value.get<std::string>().size() >= argument;
    }
    if (keyword == "pattern") {
      return !value.is_string() ||
             std::regex_search(value.get<std::string>(), std::regex(argument.get<std::string>()));
    }
    if (keyword == "required") {
      return std::ranges::all_of(argument, [&](const json& name) { return value.contains(name); });
    }
    ADD_FAILURE() << "keyword '" << keyword << "' is not checked";
    return false;
  }

  static std::string KeywordFault(const json& value, const json& schema, const std::string& keyword,
                                  const json& argument, const std::string& path) {
    static const std::set<std::string> kNotes = {"$schema", "title", "default", "description"};
    if (kNotes.contains(keyword)) return "";
    if (keyword == "properties" || keyword == "additionalProperties") {
      return value.is_object() ? MembersFault(value, schema, path) : "";
    }
    if (keyword == "propertyNames") {
      for (const auto& [name, member] : value.items()) {
        if (!Fault(name, argument).empty()) return path + ": propertyNames";
      }
      return "";
    }
    if (keyword == "items") return value.is_array() ? ElementsFault(value, argument, path) : "";
    if (keyword == "dependentRequired") {
      for (const auto& [name, needed] : argument.items()) {
        if (value.contains(name) && !Keeps(value, "required", needed)) return path + "/" + name;
      }
      return "";
    }
    if (keyword == "anyOf") {
      const auto fits = [&](const json& one) { return Fault(value, one, path).empty(); };
      return std::ranges::any_of(argument, fits) ? "" : path + ": anyOf";
    }
    return Keeps(value, keyword, argument) ? "" : path + ": " + keyword;
  }
};

}  // namespace shoal

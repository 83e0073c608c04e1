// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_schema.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/base/check.h"
#include "common/config/config_io.h"
#include "common/config/config_keys.h"
#include "common/config/value_json.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

using nlohmann::ordered_json;

// Matches at most internal::kLongestFileName characters.
constexpr char kFileName[] = "^[A-Za-z0-9_][A-Za-z0-9._-]{0,199}$";
constexpr char kFileNameOrEmpty[] = "^([A-Za-z0-9_][A-Za-z0-9._-]{0,199})?$";
static_assert(internal::kLongestFileName == 200);

ordered_json Integer(const internal::Rule& rule) {
  ordered_json schema{{"type", "integer"}};
  if (const auto* range = std::get_if<internal::IntegerRange>(&rule)) {
    schema["minimum"] = range->low;
    schema["maximum"] = range->high;
  }
  return schema;
}

ordered_json Number(const internal::Rule& rule) {
  ordered_json schema{{"type", "number"}};
  if (const auto* range = std::get_if<internal::RealRange>(&rule)) {
    schema[range->low_open ? "exclusiveMinimum" : "minimum"] = range->low;
    schema[range->high_open ? "exclusiveMaximum" : "maximum"] = range->high;
  }
  return schema;
}

ordered_json Camera() {
  const ordered_json number{{"type", "number"}};
  const ordered_json point{{"type", "array"}, {"items", number}, {"minItems", 3}, {"maxItems", 3}};
  return {{"type", "object"},
          {"properties",
           {{"lookat", point},
            {"distance", {{"type", "number"}, {"exclusiveMinimum", 0}}},
            {"azimuth", number},
            {"elevation", {{"type", "number"}, {"minimum", -90}, {"maximum", 90}}},
            {"body", {{"type", "string"}, {"minLength", 1}}}}},
          {"required", {"lookat", "distance", "azimuth", "elevation"}},
          {"additionalProperties", false}};
}

// JSON Schema of a value, by the type of its member.
struct ValueSchema {
  const internal::Rule& rule;

  ordered_json operator()(const bool*) const { return {{"type", "boolean"}}; }
  ordered_json operator()(const int*) const { return Integer(rule); }
  ordered_json operator()(const int64_t*) const { return Integer(rule); }
  ordered_json operator()(const double*) const { return Number(rule); }
  ordered_json operator()(const std::string*) const {
    ordered_json schema{{"type", "string"}};
    if (const auto* choices = std::get_if<internal::Choices>(&rule))
      schema["enum"] = choices->words;
    if (const auto* name = std::get_if<internal::FileName>(&rule)) {
      schema["pattern"] = name->optional ? kFileNameOrEmpty : kFileName;
    }
    return schema;
  }
  ordered_json operator()(const StateBlocks*) const {
    const ordered_json names{
        {"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}, {"uniqueItems", true}};
    return {{"anyOf", {ordered_json{{"type", "boolean"}}, names}}};
  }
  ordered_json operator()(const std::vector<int>*) const {
    return {{"type", "array"}, {"items", Integer(rule)}};
  }
  ordered_json operator()(const std::vector<std::string>*) const {
    return {{"type", "array"}, {"items", {{"type", "string"}}}};
  }
  ordered_json operator()(const std::map<std::string, std::array<double, 2>>*) const {
    const ordered_json interval{
        {"type", "array"}, {"items", Number(rule)}, {"minItems", 2}, {"maxItems", 2}};
    return {{"type", "object"}, {"additionalProperties", interval}};
  }
  ordered_json operator()(const std::map<std::string, CustomCamera>*) const {
    return {{"type", "object"},
            {"propertyNames", {{"minLength", 1}}},
            {"additionalProperties", Camera()}};
  }
  ordered_json operator()(const KeywordArguments*) const { return {{"type", "object"}}; }
  ordered_json operator()(const Schedule*) const {
    // Blanks are allowed only behind commas, as in ParseSchedule.
    const std::string number = R"(-?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?)";
    const ordered_json text{
        {"type", "string"},
        {"pattern", fmt::format(R"(^linear\({0}, *{0}, *0*[1-9][0-9]{{0,12}}\)$)", number)}};
    return {{"anyOf", {Number(rule), text}}};
  }
};

ordered_json KeySchema(const internal::Key& key, Config& defaults) {
  ordered_json schema = std::visit(ValueSchema{key.rule}, key.slot(defaults));
  schema["default"] =
      std::visit([](const auto* slot) { return ordered_json(*slot); }, key.slot(defaults));
  schema["description"] = std::string(key.meaning);
  return schema;
}

ordered_json ObjectOfKeys() {
  return {
      {"type", "object"}, {"properties", ordered_json::object()}, {"additionalProperties", false}};
}

// Adds the members of a file that are not keys: its schema and, in a run's config.json, the
// description of the run.
void AddWhatIsNoKey(ordered_json* schema) {
  ordered_json& properties = (*schema)["properties"];
  properties["$schema"] = {{"type", "string"}, {"description", "for editors; programs skip it"}};
  properties["schema"] = {{"const", kConfigSchema}, {"description", "of a run's config.json"}};
  for (const char* name : {"spec", "spec_hash", "config_hash"}) {
    properties[name] = {{"description", "of a run's config.json; skipped when it is read"}};
    (*schema)["dependentRequired"][name] = {"schema"};
  }
}

}  // namespace

ordered_json ConfigSchema() {
  ordered_json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                      {"title", "Configuration of a Shoal run"}};
  schema.update(ObjectOfKeys());
  Config defaults;
  for (const internal::Key& key : internal::Keys()) {
    const size_t dot = key.path.find('.');
    ordered_json* object = &schema;
    if (dot != std::string_view::npos) {
      const std::string section(key.path.substr(0, dot));
      object = &schema["properties"][section];
      if (object->is_null()) *object = ObjectOfKeys();
    }
    const std::string name(key.path.substr(dot == std::string_view::npos ? 0 : dot + 1));
    CHECK(name.find('.') == std::string::npos) << key.path;
    (*object)["properties"][name] = KeySchema(key, defaults);
  }
  AddWhatIsNoKey(&schema);
  return schema;
}

}  // namespace shoal

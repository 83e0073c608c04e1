// SPDX-License-Identifier: Apache-2.0
#include "common/config/config_schema.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/config_keys.h"
#include "common/run_folder/run_file_names.h"
#include "tests/common/config/schema_check.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using nlohmann::json;

const json& Schema() {
  static const json schema = json::parse(ConfigSchema().dump());
  return schema;
}

// {"learner": {"batch": VALUE}} of "learner.batch".
json Nested(std::string_view path, const json& value) {
  const size_t dot = path.find('.');
  if (dot == std::string_view::npos) return {{std::string(path), value}};
  return {{std::string(path.substr(0, dot)), {{std::string(path.substr(dot + 1)), value}}}};
}

bool ParserTakes(const json& object) {
  Config config;
  try {
    ApplyJson(object, "test", &config);
    return true;
  } catch (const Error&) {
    return false;
  }
}

const json& SchemaOf(std::string_view path) {
  const json* schema = &Schema();
  for (size_t start = 0; start <= path.size();) {
    const size_t dot = std::min(path.find('.', start), path.size());
    schema = &schema->at("properties").at(std::string(path.substr(start, dot - start)));
    start = dot + 1;
  }
  return *schema;
}

// Values of every type and on both sides of every bound.
std::vector<json> Probes(const internal::Rule& rule) {
  std::vector<json> probes = {nullptr,
                              true,
                              0,
                              1,
                              -1,
                              0.5,
                              3.0,
                              1e300,
                              "",
                              "word",
                              ".hidden",
                              "a/b",
                              "-x",
                              "a.b-c_1",
                              json::array(),
                              {1, 2},
                              {0.5},
                              {"a", "b"},
                              {"a", "a"},
                              {-1},
                              json::object(),
                              {{"a", {1, 2}}},
                              {{"a", {1}}},
                              {{"a", {-1, 2}}},
                              {{"a", 1}},
                              "linear(0.5,0.25,1000)",
                              "linear(0.5, .25,1000)",
                              "linear(5e-1,1.,01000)",
                              "linear(0.5,0.25,1e3)",
                              "linear(0.5,0.25,0)",
                              "linear(0..5,0.25,10)",
                              "linear(a,0.25,10)",
                              "linear(0.5 ,0.25,10)",
                              "linear(1,2)",
                              "linear(0.5,0.25,1000) "};
  const json camera = {{"lookat", {0, 0, 0}}, {"distance", 1}, {"azimuth", 0}, {"elevation", -90}};
  probes.push_back({{"top", camera}});
  probes.push_back({{"", camera}});
  for (const auto& [member, value] : std::vector<std::pair<std::string, json>>{
           {"distance", 0}, {"elevation", -91}, {"lookat", {0, 0}}, {"more", 1}}) {
    json other = camera;
    other[member] = value;
    probes.push_back({{"top", other}});
  }
  if (const auto* range = std::get_if<internal::IntegerRange>(&rule)) {
    for (int64_t bound : {range->low, range->high}) {
      for (int64_t step : {-1, 0, 1}) {
        int64_t near = 0;
        if (!__builtin_add_overflow(bound, step, &near)) {
          probes.push_back(near);
          probes.push_back({near});
        }
      }
    }
  }
  if (const auto* range = std::get_if<internal::RealRange>(&rule)) {
    for (double bound : {range->low, range->high}) {
      for (double step : {-1e-3, 0.0, 1e-3}) {
        probes.push_back(bound + step);
        probes.push_back({{"a", {bound + step, range->high}}});
      }
    }
  }
  if (const auto* choices = std::get_if<internal::Choices>(&rule)) {
    for (std::string_view word : choices->words) probes.push_back(word);
  }
  return probes;
}

TEST(ConfigSchema, TakesAndRefusesOfEachKeyWhatTheParserDoes) {
  for (const internal::Key& key : internal::Keys()) {
    int taken = 0, refused = 0;
    for (const json& probe : Probes(key.rule)) {
      const json object = Nested(key.path, probe);
      const bool takes = ParserTakes(object);
      ++(takes ? taken : refused);
      EXPECT_EQ(SchemaCheck::Fault(object, Schema()).empty(), takes)
          << object << ": " << SchemaCheck::Fault(object, Schema());
    }
    EXPECT_GT(taken, 0) << key.path;
    EXPECT_GT(refused, 0) << key.path;
  }
}

TEST(ConfigSchema, SaysOfEachKeyItsDefaultAndMeaning) {
  const json defaults = json::parse(ToJson(Config{}).dump());
  for (const internal::Key& key : internal::Keys()) {
    const json& schema = SchemaOf(key.path);
    std::string pointer = fmt::format("/{}", key.path);
    std::ranges::replace(pointer, '.', '/');
    EXPECT_EQ(schema.at("default"), defaults.at(json::json_pointer(pointer))) << key.path;
    EXPECT_EQ(schema.at("description"), key.meaning);
  }
}

TEST(ConfigSchema, EveryPresetKeepsToIt) {
  for (const std::string& name : ListPresets()) {
    EXPECT_EQ(SchemaCheck::Fault(json::parse(ReadFile(FindPreset(name))), Schema()), "") << name;
    EXPECT_EQ(SchemaCheck::Fault(json::parse(ToJson(LoadPreset(name)).dump()), Schema()), "")
        << name;
  }
}

TEST(ConfigSchema, KnowsNoOtherKeysThanTheParser) {
  EXPECT_EQ(SchemaCheck::Fault({{"sed", 3}}, Schema()), "/sed: additionalProperties");
  EXPECT_EQ(SchemaCheck::Fault({{"learner", {{"btach", 3}}}}, Schema()),
            "/learner/btach: additionalProperties");
}

TEST(ConfigSchema, ARunsOwnFileKeepsToItAndAFileMayNameIt) {
  const TemporaryFolder folder;
  const auto check = [&](const json& file, bool takes) {
    WriteFileAtomically(folder.path() / "file.json", file.dump());
    Config config;
    bool taken = true;
    try {
      ApplyFile(folder.path() / "file.json", &config);
    } catch (const Error&) {
      taken = false;
    }
    EXPECT_EQ(taken, takes) << file;
    EXPECT_EQ(SchemaCheck::Fault(file, Schema()).empty(), takes) << file;
  };
  check({{"$schema", "shoal.schema.json"}, {"seed", 3}}, true);
  check({{"$schema", 3}}, false);
  check({{"schema", kConfigSchema}, {"spec", json::object()}, {"seed", 3}}, true);
  check({{"spec", json::object()}}, false);
  check({{"schema", "shoal-config-0"}}, false);
}

}  // namespace
}  // namespace shoal

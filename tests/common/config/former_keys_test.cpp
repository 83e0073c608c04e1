// SPDX-License-Identifier: Apache-2.0
#include "common/config/former_keys.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "common/config/config_io.h"
#include "common/config/meant_key.h"
#include "common/config/run_files.h"
#include "tests/support/error_message.h"
#include "tests/support/paths.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

// Former name, present name, and a value that is not the default.
struct Renamed {
  const char *former, *present, *value;
};
constexpr Renamed kRenamed[] = {
    {"learner.temperature", "sac.temperature", R"("fixed")"},
    {"learner.initial_temperature", "sac.initial_temperature", "0.5"},
    {"learner.min_temperature", "sac.min_temperature", "0.01"},
    {"learner.temperature_learning_rate", "sac.temperature_learning_rate", "1e-4"},
    {"learner.target_entropy", "sac.target_entropy", "-3"},
    {"learner.target_entropy_per_action", "sac.target_entropy_per_action", "-0.5"},
    {"learner.critic_blocks", "sac.critic_blocks", R"(["object"])"},
    {"learner.aux", "sac.aux", R"(["object-grip"])"},
    {"learner.aux_weight", "sac.aux_weight", "2"},
    {"ppo.normalise_observations", "learner.normalise_vectors", "true"},
};

json InSection(const std::string& path, const char* value) {
  const size_t dot = path.find('.');
  return {{path.substr(0, dot), {{path.substr(dot + 1), json::parse(value)}}}};
}

Config Assigned(const std::string& name, const char* value) {
  Config config;
  ApplyAssignments({fmt::format("{}={}", name, value)}, &config);
  return config;
}

TEST(FormerKeys, AreTakenEverywhereWithOneNote) {
  for (const auto& [former, present, value] : kRenamed) {
    testing::internal::CaptureStderr();
    Config applied;
    ApplyJson(InSection(former, value), "x.json", &applied);
    const nlohmann::ordered_json expected = ToJson(Assigned(present, value));
    EXPECT_EQ(ToJson(applied), expected) << former;
    EXPECT_EQ(ToJson(Assigned(former, value)), expected) << former;
    EXPECT_NE(ToJson(Config()), expected) << former;
    const MeantKey option = FindMeantKey(former);
    EXPECT_TRUE(option.same);
    EXPECT_EQ(ToJson(Assigned(option.key, value)), expected) << former;
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              fmt::format("shoal: note: the key {} is called {} now; its former name works until "
                          "version 0.3\n",
                          former, present));
  }
}

TEST(FormerKeys, OfARunsConfigurationAreReadWithoutANote) {
  const TemporaryFolder run;
  RunConfig written;
  ApplyAssignments({"sac.initial_temperature=0.25", "sac.critic_blocks=true"}, &written.config);
  written.spec.task = "FetchPush";
  written.spec.blocks = {{"observation", 10}};
  WriteRunConfig(run.path(), written);
  // Version 0.1 wrote the section's keys among the learner's. It lacked the keys of ensembles and
  // quantiles.
  json object = json::parse(ReadFile(run.path() / "config.json"));
  for (const char* later :
       {"critics", "target_critics", "actor_value", "quantiles", "dropped_quantiles"}) {
    object["sac"].erase(later);
  }
  object["learner"].update(object.at("sac"));
  object.erase("sac");
  ASSERT_TRUE(object["learner"].contains("target_entropy"));
  WriteFileAtomically(run.path() / "config.json", object.dump());
  testing::internal::CaptureStderr();
  EXPECT_EQ(ToJson(ReadRunConfig(run.path()).config), ToJson(written.config));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// tests/golden/config/version_0_1.json was written by version 0.1.0: shoal train --preset
// `fetch-push-pixels` with other values for the keys that have new names.
TEST(FormerKeys, OfARunOfVersion01KeepTheirValues) {
  const TemporaryFolder run;
  std::filesystem::copy_file(GoldenPath("config/version_0_1.json"), run.path() / "config.json");
  const Config config = ReadRunConfig(run.path()).config;
  EXPECT_EQ(config.preset, "fetch-push-pixels");
  EXPECT_EQ(config.sac.temperature, "auto");
  EXPECT_EQ(config.sac.initial_temperature, 0.25);
  EXPECT_EQ(config.sac.min_temperature, 0.01);
  EXPECT_EQ(config.sac.temperature_learning_rate, 1e-4);
  EXPECT_EQ(config.sac.target_entropy, -3);
  EXPECT_EQ(config.sac.target_entropy_per_action, -1);
  EXPECT_TRUE(config.sac.critic_blocks.all);
  EXPECT_EQ(config.sac.aux, std::vector<std::string>{"object-grip"});
  EXPECT_EQ(config.sac.aux_weight, 2);
  EXPECT_TRUE(config.learner.normalise_vectors);
}

TEST(FormerKeys, BesideThePresentNameAreRefused) {
  Config config;
  EXPECT_THAT(UsageMessage([&] {
                ApplyAssignments({"sac.aux_weight=2", "learner.aux_weight=2"}, &config);
              }),
              HasSubstr("--set: key 'sac.aux_weight' given twice (as 'learner.aux_weight')"));
  json both = InSection("sac.aux_weight", "2");
  both.update(InSection("learner.aux_weight", "3"));
  EXPECT_THAT(UsageMessage([&] { ApplyStoredJson(both, "x.json", &config); }),
              HasSubstr("x.json: key 'sac.aux_weight' given twice"));
}

TEST(FormerKeys, OtherNamesArePresentOnes) {
  EXPECT_EQ(PresentName("learner.batch"), "learner.batch");
  EXPECT_EQ(PresentName("no.key"), "no.key");
  testing::internal::CaptureStderr();
  NoteFormerName("learner.batch");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
#include "common/config/value_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/config/config_io.h"

namespace shoal {
namespace {

using testing::HasSubstr;

constexpr char kTop[] =
    R"({"lookat": [1.34, 0.75, 0.5], "distance": 1.2, "azimuth": 180, "elevation": -80})";

Config Applied(const std::string& cameras) {
  Config config;
  const std::string text = R"({"observation": {"custom_cameras": )" + cameras + "}}";
  ApplyJson(ParseStrictJson(text, "x.json"), "x.json", &config);
  return config;
}

std::string Complaint(const std::string& cameras) {
  try {
    Applied(cameras);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    return error.what();
  }
  return "";
}

TEST(CustomCamera, IsReadByName) {
  const Config config = Applied(R"({"top": )" + std::string(kTop) + "}");
  ASSERT_EQ(config.observation.custom_cameras.size(), 1u);
  const CustomCamera& top = config.observation.custom_cameras.at("top");
  EXPECT_EQ(top, (CustomCamera{{1.34, 0.75, 0.5}, 1.2, 180, -80}));
}

TEST(CustomCamera, SurvivesBeingWrittenAndReadAndIsPartOfTheRunsIdentity) {
  const Config config = Applied(R"({"top": )" + std::string(kTop) + "}");
  Config again;
  ApplyJson(nlohmann::json::parse(ToJson(config).dump()), "again", &again);
  EXPECT_EQ(again.observation.custom_cameras, config.observation.custom_cameras);
  EXPECT_NE(ConfigHash(config), ConfigHash(Config{}));
  EXPECT_THAT(DescribeKeys(), HasSubstr("observation.custom_cameras"));
}

TEST(CustomCamera, MayBeMountedOnABody) {
  const Config config = Applied(R"({"hand": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0,
                                       "elevation": 0, "body": "palm"}})");
  EXPECT_EQ(config.observation.custom_cameras.at("hand").body, "palm");
  Config again;
  ApplyJson(nlohmann::json::parse(ToJson(config).dump()), "again", &again);
  EXPECT_EQ(again.observation.custom_cameras, config.observation.custom_cameras);
}

TEST(CustomCamera, CanBeGivenWithSet) {
  Config config;
  ApplyAssignments({R"(observation.custom_cameras={"top": )" + std::string(kTop) + "}"}, &config);
  EXPECT_TRUE(config.observation.custom_cameras.contains("top"));
}

TEST(CustomCamera, AnythingWrongIsRefusedNamingTheKeyAndWhatItTakes) {
  const char* const wrong[] = {
      R"([])",
      R"({"": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0, "elevation": 0}})",
      R"({"top": 3})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0, "elevation": 0, "fov": 45}})",
      R"({"top": {"lookat": [0, 0], "distance": 1, "azimuth": 0, "elevation": 0}})",
      R"({"top": {"lookat": [0, 0, "a"], "distance": 1, "azimuth": 0, "elevation": 0}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 0, "azimuth": 0, "elevation": 0}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuth": "left", "elevation": 0}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0, "elevation": 91}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuht": 0, "elevation": 0}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0, "elevation": 0, "body": ""}})",
      R"({"top": {"lookat": [0, 0, 0], "distance": 1, "azimuth": 0, "elevation": 0, "body": 1}})",
  };
  for (const char* cameras : wrong) {
    EXPECT_THAT(Complaint(cameras), testing::AllOf(HasSubstr("observation.custom_cameras"),
                                                   HasSubstr("lookat: [x, y, z]")))
        << cameras;
  }
}

StateBlocks Proprioception(const std::string& value) {
  Config config;
  ApplyAssignments({"observation.proprioception=" + value}, &config);
  return config.observation.proprioception;
}

TEST(StateBlocks, AreAllNoneOrThoseNamed) {
  EXPECT_TRUE(Proprioception("true").all);
  EXPECT_FALSE(Proprioception("false"));
  const StateBlocks named = Proprioception(R"(["grip", "fingers"])");
  EXPECT_TRUE(named);
  EXPECT_FALSE(named.all);
  EXPECT_EQ(named.names, (std::vector<std::string>{"grip", "fingers"}));
}

TEST(StateBlocks, ComeBackFromJson) {
  for (const char* value : {"true", "false", R"(["grip","fingers"])"}) {
    Config config;
    ApplyAssignments({std::string("observation.proprioception=") + value}, &config);
    EXPECT_EQ(ToJson(config).at("observation").at("proprioception").dump(), value);
    Config again;
    ApplyJson(nlohmann::json(ToJson(config)), "test", &again);
    EXPECT_EQ(ConfigHash(again), ConfigHash(config));
  }
}

TEST(StateBlocks, AnythingElseIsRefusedSayingWhatTheKeyTakes) {
  for (const char* value : {"[]", "1", "grip", R"(["grip", "grip"])", R"(["grip", 1])", "{}"}) {
    try {
      Proprioception(value);
      ADD_FAILURE() << value;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit_code(), 2);
      EXPECT_THAT(error.what(), HasSubstr("true, false or a list of block names")) << value;
    }
  }
}

}  // namespace
}  // namespace shoal

#include "common/config/custom_camera_json.h"

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
  };
  for (const char* cameras : wrong) {
    EXPECT_THAT(Complaint(cameras), testing::AllOf(HasSubstr("observation.custom_cameras"),
                                                   HasSubstr("lookat: [x, y, z]")))
        << cameras;
  }
}

}  // namespace
}  // namespace shoal

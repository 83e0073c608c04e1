// `shoal-actor --describe` for every kind of observation.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/config/config_io.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

TEST(Describe, SaysWhatEachKindOfObservationConsistsOf) {
  const TemporaryFolder folder;
  int number = 0;
  for (const char* mode : {"none", "desired", "both"}) {
    for (const bool state : {false, true}) {
      for (const bool grey : {false, true}) {
        Config config;
        config.observation.goal_mode = mode;
        config.observation.proprioception = state;
        config.observation.grey = grey;
        config.observation.stack = 1 + number % 4;
        config.observation.height = 40 + 4 * number;
        config.observation.cameras = {"close", "top"};
        config.observation.custom_cameras["top"] = {{1.34, 0.75, 0.5}, 1.2, 180, -80};
        const auto file = folder.path() / "config.json";
        WriteFileAtomically(file, ToJson(config).dump());
        const ProgramResult result =
            RunProgram({"shoal-actor", "--describe", "--config-json", file.string()},
                       std::chrono::seconds(30));
        ASSERT_EQ(ExitCode(result), 0) << result.err;
        const auto spec = nlohmann::json::parse(result.out);
        EXPECT_EQ(spec.at("channels"), grey ? 2 : 6);
        EXPECT_EQ(spec.at("height"), 40 + 4 * number);
        EXPECT_EQ(spec.at("width"), 84);
        EXPECT_GT(spec.at("frame_microseconds"), 1);
        EXPECT_EQ(spec.at("stack"), 1 + number % 4);
        EXPECT_EQ(spec.at("cameras"), (std::vector<std::string>{"close", "top"}));
        std::vector<std::string> blocks;
        for (const auto& block : spec.at("blocks")) {
          if (block.at("observed")) blocks.push_back(block.at("name"));
        }
        std::vector<std::string> expected;
        if (state) expected = {"grip", "fingers", "grip_velocity", "finger_velocities"};
        if (std::string(mode) == "both") expected.push_back("achieved_goal");
        if (std::string(mode) != "none") expected.push_back("desired_goal");
        EXPECT_EQ(blocks, expected);
        ++number;
      }
    }
  }
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// `shoal-actor --describe` for every kind of observation, and `shoal env describe` of runs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/config/config_io.h"
#include "common/config/run_files.h"
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

// The inputs of a preset are queried from its actors, those of a run are read from its folder.
TEST(Describe, ListsWhatThePolicyOfAPresetOrARunGets) {
  const TemporaryFolder folder;
  const auto describe = [&](const std::string& option, const std::string& name) {
    const std::string file = folder.path() / "inputs.json";
    const ProgramResult result = RunProgram({"shoal", "env", "describe", option, name, "--run-dir",
                                             folder.path().string(), "--json", file},
                                            std::chrono::seconds(30));
    EXPECT_EQ(ExitCode(result), 0) << result.err;
    return std::pair(result.out, nlohmann::json::parse(ReadFile(file)));
  };
  const auto [text, inputs] = describe("--preset", "fetch-push-pixels");
  EXPECT_NE(text.find("FetchPush: what the policy gets, in training and at test time:\n"
                      "  pictures  front, side at 64x64, 1 frame(s), the goal's marker hidden\n"
                      "  numbers   grip (3), fingers (2), grip_velocity (3), "
                      "finger_velocities (2), desired_goal (3)\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(inputs.at("policy_inputs").at("object_blocks"), nlohmann::json::array());
  EXPECT_EQ(inputs.at("privileged_inputs").at("labels"), nlohmann::json({"object-grip"}));

  RunConfig run;
  run.spec.task = "FetchPush";
  run.spec.blocks = {{"grip", 3}, {"object", 3}};
  run.spec.action_size = 4;
  std::filesystem::create_directory(folder.path() / "mine");
  WriteRunConfig(folder.path() / "mine", run);
  EXPECT_NE(describe("--run", "mine").first.find("numbers   grip (3), object (3)\n"),
            std::string::npos);
}

}  // namespace
}  // namespace shoal

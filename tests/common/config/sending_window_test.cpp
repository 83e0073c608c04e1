// SPDX-License-Identifier: Apache-2.0
#include "common/config/sending_window.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace shoal {
namespace {

Config Asked(int chunk_records, int window_chunks) {
  Config config;
  config.transport.chunk_records = chunk_records;
  config.replay.window_chunks = window_chunks;
  return config;
}

TEST(SendingWindow, SmallRecordsTravelInTheChunksAskedFor) {
  const SendingWindow window = SendingWindowOf(Asked(24, 4), 42'440);  // two cameras of 84x84
  EXPECT_EQ(window.chunk_records, 24);
  EXPECT_EQ(window.chunks, 4);
}

TEST(SendingWindow, LargeRecordsTravelInMoreChunksOfAtMostAMebibyte) {
  const SendingWindow window = SendingWindowOf(Asked(24, 4), 200'000);
  EXPECT_EQ(window.chunk_records, 5);
  EXPECT_EQ(window.chunks, 19) << "95 of the 96 records asked for";
  EXPECT_EQ(window.records(), 95);
}

TEST(SendingWindow, AnActorNeedsItsOldestChunkAndAStepOfAllItsEnvironmentsToGoOn) {
  Config config = Asked(24, 4);
  config.envs_per_actor = 4;
  EXPECT_EQ(SendingWindowOf(config, 42'440).least_records, 24);
  EXPECT_EQ(SendingWindowOf(config, 200'000).least_records, 8);
  config.envs_per_actor = 16;
  EXPECT_EQ(SendingWindowOf(config, 42'440).least_records, 32);
  config.observation.goal_mode = "image";
  EXPECT_EQ(SendingWindowOf(config, 42'440).least_records, 48) << "with a goal record each";
}

TEST(SendingWindow, EnvironmentsThatDoNotFitAreRefusedNamingWhatWouldHelp) {
  Config config = Asked(24, 4);
  config.envs_per_actor = 48;
  EXPECT_NO_THROW(CheckSendingWindow(config, 1000));
  config.envs_per_actor = 49;
  try {
    CheckSendingWindow(config, 1000);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    EXPECT_NE(std::string(e.what()).find("envs_per_actor 49"), std::string::npos);
    EXPECT_NE(std::string(e.what()).find("replay.window_chunks"), std::string::npos);
  }
}

TEST(SendingWindow, NeverLetsAChunkExceedItsBoundUnlessOneRecordDoes) {
  for (const int bytes : {8, 1000, 42'440, 300'000, 524'288, 524'296, 1'000'100}) {
    for (const int records : {1, 24, 4096}) {
      const SendingWindow window = SendingWindowOf(Asked(records, 2), bytes);
      EXPECT_LE(int64_t{window.chunk_records} * bytes, std::max<int64_t>(kChunkBytes, bytes));
      EXPECT_GE(window.chunk_records, 1);
      EXPECT_GE(window.chunks, 2);
      EXPECT_LE(window.records(), 2 * records);
    }
  }
  EXPECT_EQ(SendingWindowOf(Asked(24, 2), 2'000'000).chunk_records, 1);
}

}  // namespace
}  // namespace shoal

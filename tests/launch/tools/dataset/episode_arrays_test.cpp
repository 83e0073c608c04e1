// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/episode_arrays.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/launch/tools/dataset/read_hdf5.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

class EpisodeArraysTest : public testing::Test {
 protected:
  // An episode of two steps, the second of which ended it.
  std::vector<std::vector<uint8_t>> Episode(uint8_t end) const {
    std::vector<std::vector<uint8_t>> records;
    for (uint32_t index = 0; index < 3; ++index) {
      records.push_back(
          replay::MakeRecord(spec_, 0, 7, 11, index, index + 1, index == 2 ? end : uint8_t{0}));
    }
    return records;
  }
  void Write(const std::vector<std::vector<uint8_t>>& records) const {
    std::vector<uint8_t> bytes;
    for (const auto& record : records) bytes.insert(bytes.end(), record.begin(), record.end());
    Hdf5File file(path_);
    WriteEpisode(spec_, bytes, 4, &file);
    file.Finish();
  }

  ObservationSpec spec_ = replay::TinySpec(3);
  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "main_data.hdf5";
};

TEST_F(EpisodeArraysTest, AnEpisodeHasOneObservationMoreThanSteps) {
  Write(Episode(kTerminated));
  const Hdf5Reader reader(path_);
  EXPECT_THAT(reader.Names(), ElementsAre("episode_4"));
  const auto shape = [&](const char* name) {
    return reader.Describe("episode_4/" + std::string(name)).shape;
  };
  for (const char* block : {"grip", "achieved_goal", "desired_goal"}) {
    EXPECT_THAT(shape(("observations/" + std::string(block)).c_str()), ElementsAre(3, 2)) << block;
  }
  EXPECT_THAT(shape("observations/pixels"), ElementsAre(3, 2, 3, 5)) << "frames, not stacks";
  EXPECT_THAT(shape("actions"), ElementsAre(2, 2));
  for (const char* name : {"rewards", "terminations", "truncations"}) {
    EXPECT_THAT(shape(name), ElementsAre(2)) << name;
  }
  EXPECT_THAT(shape("infos/distance"), ElementsAre(3));
  EXPECT_THAT(shape("infos/is_success"), ElementsAre(3));
  EXPECT_EQ(reader.Attribute("episode_4", "id"), 4);
  EXPECT_EQ(reader.Attribute("episode_4", "total_steps"), 2);
  EXPECT_EQ(reader.Attribute("episode_4", "env"), 7);
  EXPECT_EQ(reader.Attribute("episode_4", "episode"), 11);
}

TEST_F(EpisodeArraysTest, EachArrayHasTheNumbersOfTheRecords) {
  const auto records = Episode(kTruncated | kSuccess);
  Write(records);
  const Hdf5Reader reader(path_);
  const RecordLayout layout(spec_);
  std::vector<float> achieved, actions, rewards;
  std::vector<uint8_t> pixels;
  for (size_t i = 0; i < records.size(); ++i) {
    const uint8_t* record = records[i].data();
    const auto goal = layout.Vector(record).subspan(2, 2);  // behind the grip
    achieved.insert(achieved.end(), goal.begin(), goal.end());
    pixels.insert(pixels.end(), layout.Frame(record).begin(), layout.Frame(record).end());
    if (i == 0) continue;
    actions.insert(actions.end(), layout.Action(record).begin(), layout.Action(record).end());
    rewards.push_back(RecordLayout::Header(record).reward);
  }
  EXPECT_THAT(reader.Floats("episode_4/observations/achieved_goal"), ElementsAreArray(achieved));
  EXPECT_EQ(reader.Bytes("episode_4/observations/pixels"), pixels);
  EXPECT_THAT(reader.Floats("episode_4/actions"), ElementsAreArray(actions));
  EXPECT_THAT(reader.Floats("episode_4/rewards"), ElementsAreArray(rewards));
  EXPECT_THAT(reader.Flags("episode_4/terminations"), ElementsAre("FALSE", "FALSE"));
  EXPECT_THAT(reader.Flags("episode_4/truncations"), ElementsAre("FALSE", "TRUE"));
  EXPECT_THAT(reader.Flags("episode_4/infos/is_success"), ElementsAre("FALSE", "FALSE", "TRUE"));
}

TEST_F(EpisodeArraysTest, ATaskWithoutGoalsHasNoDistances) {
  auto records = Episode(kTerminated);
  for (auto& record : records) {
    RecordLayout::Header(record.data()).distance = std::numeric_limits<float>::quiet_NaN();
  }
  Write(records);
  EXPECT_FALSE(Hdf5Reader(path_).Has("episode_4/infos"));
}

TEST_F(EpisodeArraysTest, BlocksWithoutANameForAnArrayAreRefused) {
  CheckArrayNames(spec_);
  for (const char* name : {"", ".", "a/b", "pixels"}) {
    spec_.blocks[1].name = name;
    EXPECT_THAT(UsageMessage([&] { CheckArrayNames(spec_); }),
                HasSubstr("the block '" + std::string(name) + "' of task Test"));
  }
}

}  // namespace
}  // namespace shoal::launch

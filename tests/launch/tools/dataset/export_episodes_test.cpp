// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/dataset/export_episodes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "common/run_folder/run_file_names.h"
#include "replay_server/core/replay_core.h"
#include "tests/launch/tools/dataset/read_hdf5.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ExportEpisodesTest : public testing::Test {
 protected:
  ExportEpisodesTest() {
    std::filesystem::create_directory(output_.parent_path());
    asked_.run = replay::TinyRun(1, 64);
    asked_.run.config.replay.storage = "file";
    asked_.ring = folder_.path() / kRingFile;
    asked_.output = output_;
  }
  // Stores an actor's first `records` records in the ring.
  void Store(uint32_t records) {
    replay::ReplayCore core(asked_.run, folder_.path(), 1);
    core.TakeChunk(actor_.Chunk(1, records));
  }
  std::string Refusal() {
    return ErrorMessage([&] { ExportEpisodes(asked_); });
  }
  bool OutputIsEmpty() const { return std::filesystem::is_empty(output_.parent_path()); }
  // Which episodes of the run the file holds, in its order.
  std::vector<int64_t> Written() const {
    const Hdf5Reader reader(output_);
    std::vector<int64_t> episodes;
    for (size_t i = 0; i < reader.Names().size(); ++i) {
      episodes.push_back(reader.Attribute("episode_" + std::to_string(i), "episode"));
    }
    return episodes;
  }

  TemporaryFolder folder_;
  const std::filesystem::path output_ = folder_.path() / "set" / "main_data.hdf5";
  EpisodeExport asked_;
  replay::RecordScript actor_{replay::TinySpec(1), 0, 10, /*envs=*/1};
};

TEST_F(ExportEpisodesTest, EveryStepOfEveryWholeEpisodeIsThere) {
  Store(50);
  // By hand: what the script made, cut at its ends.
  std::vector<float> rewards;
  std::vector<float> whole;
  uint64_t episodes = 0;
  for (uint64_t sequence = 1; sequence <= 50; ++sequence) {
    const RecordHeader& header = RecordLayout::Header(actor_.At(sequence).data());
    if (header.kind == RecordKind::kStep) rewards.push_back(header.reward);
    if ((header.flags & (kTerminated | kTruncated)) == 0) continue;
    whole = rewards;
    ++episodes;
  }
  ASSERT_GT(episodes, 2u);
  ASSERT_LT(whole.size(), rewards.size()) << "the last one goes on";
  const ExportedEpisodes exported = ExportEpisodes(asked_);
  EXPECT_EQ(exported.episodes, episodes);
  EXPECT_EQ(exported.steps, whole.size());
  EXPECT_EQ(exported.unended, 1u);
  EXPECT_EQ(exported.overwritten, 0u);
  EXPECT_EQ(exported.bytes, std::filesystem::file_size(output_));
  const Hdf5Reader reader(output_);
  std::vector<float> read;
  for (uint64_t i = 0; i < episodes; ++i) {
    const auto part = reader.Floats("episode_" + std::to_string(i) + "/rewards");
    read.insert(read.end(), part.begin(), part.end());
  }
  EXPECT_EQ(read, whole);
  nlohmann::json metadata;
  metadata = nlohmann::json::parse(ReadFile(output_.parent_path() / "metadata.json"));
  EXPECT_EQ(metadata["total_episodes"], episodes);
  EXPECT_EQ(metadata["total_steps"], whole.size());
  EXPECT_EQ(metadata["dataset_id"], "shoal/tiny-v0");
}

TEST_F(ExportEpisodesTest, WithANumberTheFirstOrTheLastOfThem) {
  Store(60);
  const ExportedEpisodes all = ExportEpisodes(asked_);
  const std::vector<int64_t> episodes = Written();
  ASSERT_EQ(episodes.size(), all.episodes);
  ASSERT_GT(all.episodes, 4u);
  asked_.episodes = 2;
  EXPECT_EQ(ExportEpisodes(asked_).episodes, 2u);
  EXPECT_THAT(Written(), ElementsAre(episodes[0], episodes[1]));
  asked_.last = true;
  EXPECT_EQ(ExportEpisodes(asked_).episodes, 2u);
  EXPECT_THAT(Written(), ElementsAre(episodes[episodes.size() - 2], episodes.back()));
  asked_.episodes = 1000;
  EXPECT_EQ(ExportEpisodes(asked_).episodes, all.episodes);
}

TEST_F(ExportEpisodesTest, AnOverwrittenBeginningIsCountedNotExported) {
  // The eighth of a full ring that is overwritten next is left out as well: 300 - 64 + 1 + 8 is the
  // oldest record, in the middle of an episode.
  Store(300);
  const RecordHeader& oldest = RecordLayout::Header(actor_.At(245).data());
  ASSERT_GT(oldest.index, 0u);
  const ExportedEpisodes exported = ExportEpisodes(asked_);
  EXPECT_EQ(exported.overwritten, 1u);
  EXPECT_EQ(Written().front(), oldest.episode + 1);
}

TEST_F(ExportEpisodesTest, ARingWithoutAWholeEpisodeIsRefusedAndNothingWritten) {
  Store(1);
  EXPECT_THAT(Refusal(), HasSubstr("replay.ring' holds no whole episode: 0 without their "
                                   "beginning, 1 without their end"));
  EXPECT_TRUE(OutputIsEmpty());
}

TEST_F(ExportEpisodesTest, ARingThatIsMissingOrDamagedIsRefusedByName) {
  EXPECT_THAT(Refusal(), HasSubstr(asked_.ring.string()));
  std::ofstream(asked_.ring) << std::string(5000, 'x');
  EXPECT_THAT(Refusal(), HasSubstr("replay.ring' is not a replay file"));
  EXPECT_TRUE(OutputIsEmpty());
}

TEST_F(ExportEpisodesTest, AMetadataFileOfSomethingElseIsNotReplaced) {
  Store(50);
  const std::filesystem::path metadata = output_.parent_path() / "metadata.json";
  std::ofstream(metadata) << "mine";
  EXPECT_THAT(Refusal(), HasSubstr(metadata.string() + "' belongs to something else"));
  EXPECT_EQ(ReadFile(metadata), "mine");
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(ExportEpisodesTest, AFolderThatIsNotThereIsRefused) {
  Store(50);
  asked_.output = folder_.path() / "none" / "main_data.hdf5";
  EXPECT_THAT(Refusal(), HasSubstr("cannot write '" + asked_.output.string() + "': No such file"));
}

}  // namespace
}  // namespace shoal::launch

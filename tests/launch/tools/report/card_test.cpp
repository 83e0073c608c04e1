// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/card.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/launch/tools/experiment/planted_run.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class CardTest : public testing::Test {
 protected:
  CardTest() {
    run_.Begin();
    run_.WriteMeta("budget");
    run_.WriteFinal(0.95, 100);
    MakeFolders(run_.path() / "checkpoints/best");
    WriteFileAtomically(run_.path() / "checkpoints/best/policy.safetensors", "weights");
    WriteFileAtomically(run_.path() / "checkpoints/best/policy.json", "description");
    WriteFileAtomically(run_.path() / "checkpoints/best/state.json", "state");
  }

  const TemporaryFolder folder_;
  const RunPlanter run_{folder_.path() / "run"};
  const fs::path card_ = folder_.path() / "card";
};

TEST_F(CardTest, HasWhatHubsReadAndWhatPlays) {
  WriteCard(run_.path(), card_);
  const std::string readme = ReadFile(card_ / "README.md");
  EXPECT_THAT(readme, StartsWith("---\nlibrary_name: shoal\n"));
  EXPECT_THAT(readme, HasSubstr("model-index:\n- name: run\n"));
  EXPECT_THAT(readme, HasSubstr("value: -1.00 +/- 0.10"));
  EXPECT_THAT(readme, HasSubstr("95.0 % [88.8, 97.8] (95/100)"));
  EXPECT_THAT(readme, HasSubstr("`shoal train --config config.json --run-name run-again --set "
                                "run_dir=runs`"));
  const auto results = nlohmann::json::parse(ReadFile(card_ / "results.json"));
  EXPECT_EQ(results.at("mean_reward"), -1.0);
  EXPECT_EQ(results.at("n_eval_episodes"), 100);
  EXPECT_EQ(ReadFile(card_ / "policy.safetensors"), "weights");
  EXPECT_EQ(ReadFile(card_ / "policy.json"), "description");
  EXPECT_EQ(ReadFile(card_ / "state.json"), "state");
  EXPECT_EQ(ReadFile(card_ / "config.json"), ReadFile(run_.path() / "config.json"));
  EXPECT_FALSE(fs::exists(card_ / "replay.mp4"));
}

TEST_F(CardTest, AFilmComesAlong) {
  MakeFolders(run_.path() / "videos");
  WriteFileAtomically(run_.path() / "videos/a.mp4", "film");
  WriteCard(run_.path(), card_);
  EXPECT_EQ(ReadFile(card_ / "replay.mp4"), "film");
}

TEST_F(CardTest, NothingIsOverwrittenOrLeftHalfWritten) {
  WriteCard(run_.path(), card_);
  EXPECT_THROW(WriteCard(run_.path(), card_), Error);
  fs::remove(run_.path() / "checkpoints/best/policy.safetensors");
  EXPECT_THROW(WriteCard(run_.path(), folder_.path() / "other"), Error);
  fs::remove(run_.path() / "eval/final.json");
  EXPECT_THROW(WriteCard(run_.path(), folder_.path() / "other"), Error);
  EXPECT_FALSE(fs::exists(folder_.path() / "other"));
  EXPECT_FALSE(fs::exists(folder_.path() / "other.tmp"));
}

}  // namespace
}  // namespace shoal::launch

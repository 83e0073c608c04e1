// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/peek.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/run_files.h"
#include "replay_server/core/replay_core.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

using testing::HasSubstr;

class PeekTest : public testing::Test {
 protected:
  PeekTest() : run_(TinyRun(2, 64)) {
    run_.config.replay.storage = "file";
    run_.config.replay.shift_pad = 1;
    WriteRunConfig(folder_.path(), run_);
  }
  std::string Refusal() {
    return ErrorMessage([&] { PeekBatch(folder_.path(), 4, 1); });
  }

  RunConfig run_;
  TemporaryFolder folder_;
  RecordScript actor_{TinySpec(2), 0, 10};
};

TEST_F(PeekTest, PaintsEveryElementBesideARunningServer) {
  ReplayCore core(run_, folder_.path(), 1);
  core.TakeChunk(actor_.Chunk(1, 40));
  const Peek peek = PeekBatch(folder_.path(), 4, 1);
  EXPECT_EQ(peek.records, core.ring().last_id());
  EXPECT_EQ(peek.sampleable, core.index().sampleable());
  // 4 columns of 5 pixels, 2 cameras x 4 rows of 3 pixels, 2 pixels around each.
  EXPECT_EQ(peek.width, 4 * 7 + 2);
  EXPECT_EQ(peek.height, 8 * 5 + 2);
  ASSERT_EQ(peek.rgb.size(), size_t(peek.width * peek.height * 3));
  ASSERT_EQ(peek.captions.size(), 4u);
  EXPECT_THAT(peek.captions[0], HasSubstr("episode 10"));
}

TEST_F(PeekTest, ShowsThePredecessorsFrameAndThenTheStepsOwn) {
  ReplayCore core(run_, folder_.path(), 1);
  core.TakeChunk(actor_.Chunk(1, 40));
  const Peek peek = PeekBatch(folder_.path(), 1, 1);
  uint64_t id = 0;
  ASSERT_EQ(std::sscanf(peek.captions[0].c_str(), "record %lu", &id), 1);
  const auto pixel = [&](int row) { return peek.rgb[((2 + row * 5) * peek.width + 2) * 3]; };
  const RecordLayout& layout = core.ring().layout();
  const auto obs = layout.Frame(core.ring().Record(core.ring().Slot(id).prev));
  const auto next_obs = layout.Frame(core.ring().Record(id));
  EXPECT_EQ(pixel(0), obs[0]) << "camera a, top left, not shifted";
  EXPECT_EQ(pixel(2), next_obs[0]);
  EXPECT_EQ(pixel(4), obs[15]) << "camera b";
  EXPECT_EQ(pixel(6), next_obs[15]);
}

TEST_F(PeekTest, ObservationsAreThoseOfTheSameDrawNotShifted) {
  ReplayCore core(run_, folder_.path(), 1);
  core.TakeChunk(actor_.Chunk(1, 40));
  const Peek peek = PeekBatch(folder_.path(), 1, 1);
  uint64_t id = 0;
  ASSERT_EQ(std::sscanf(peek.captions[0].c_str(), "record %lu", &id), 1);
  const PeekedObservations peeked = PeekObservations(folder_.path(), 1, 1);
  const auto newest = core.ring().layout().Frame(core.ring().Record(core.ring().Slot(id).prev));
  ASSERT_EQ(peeked.frames.size(), newest.size() * size_t(run_.spec.stack));
  EXPECT_TRUE(std::equal(newest.rbegin(), newest.rend(), peeked.frames.rbegin()));
  EXPECT_EQ(peeked.vectors.size(), size_t(run_.spec.VectorSize()));
  EXPECT_THROW(PeekObservations(folder_.path() / "absent", 1, 1), Error);
}

TEST_F(PeekTest, TheSameSeedShowsTheSame) {
  ReplayCore core(run_, folder_.path(), 1);
  core.TakeChunk(actor_.Chunk(1, 40));
  EXPECT_EQ(PeekBatch(folder_.path(), 4, 1).rgb, PeekBatch(folder_.path(), 4, 1).rgb);
  EXPECT_NE(PeekBatch(folder_.path(), 4, 1).rgb, PeekBatch(folder_.path(), 4, 2).rgb);
}

TEST_F(PeekTest, SaysWhatIsMissing) {
  EXPECT_THAT(Refusal(), HasSubstr("--set replay.keep=true"));
  ReplayCore core(run_, folder_.path(), 1);
  EXPECT_THAT(Refusal(), HasSubstr("no step that can be sampled"));
  run_.config.replay.storage = "memory";
  WriteRunConfig(folder_.path(), run_);
  EXPECT_THAT(Refusal(), HasSubstr("in memory"));
}

}  // namespace
}  // namespace shoal::replay

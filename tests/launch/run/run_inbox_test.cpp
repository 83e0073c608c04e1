// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_inbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/config.h"
#include "common/dds/bus.h"
#include "common/link/writer.h"
#include "tests/launch/wait_until.h"

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::IsEmpty;

template <class M>
M ReportOf(const std::string& role, uint32_t id) {
  M report;
  report.role = role;
  report.id = id;
  return report;
}

// Uses a separate bus, on which a message arrives before its Write returns.
class RunInboxTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(WaitUntil([&] {
      return actor_.Matched() > 0 && learner_.Matched() > 0 && replay_.Matched() > 0 &&
             words_.Matched() > 0;
    }));
  }

  ClusterAddress address_;
  std::unique_ptr<dds::Bus> bus_ = dds::ClaimDomain(TransportConfig{}, &address_);
  RunInbox inbox_{*bus_, link::RunTopology(Config{})};
  link::Writer<ActorMetrics> actor_{*bus_};
  link::Writer<LearnerMetrics> learner_{*bus_};
  link::Writer<ReplayMetrics> replay_{*bus_};
  link::Writer<ReplayProgress> words_{*bus_};
};

TEST_F(RunInboxTest, HoldsWhatItsProcessesSayUntilItIsTaken) {
  actor_.Write(ReportOf<ActorMetrics>("actor", kMostActors - 1));
  learner_.Write(ReportOf<LearnerMetrics>("learner", 0));
  words_.Write({.replay = 0, .session = 1, .stored_steps = 7});
  EXPECT_THAT(inbox_.TakeReports(), ElementsAre(Field(&MetricsMessage::role, "actor"),
                                                Field(&MetricsMessage::role, "learner")));
  EXPECT_THAT(inbox_.TakeReports(), IsEmpty());
  EXPECT_THAT(inbox_.TakeReplayProgress(), ElementsAre(Field(&ReplayProgress::stored_steps, 7u)));
  EXPECT_EQ(inbox_.refused(), 0u);
  EXPECT_EQ(inbox_.dropped(), 0u);
}

TEST_F(RunInboxTest, ARunWithoutAReplayHearsNone) {
  Config config;
  config.learner.algorithm = "ppo";
  RunInbox inbox(*bus_, link::RunTopology(config));
  ASSERT_TRUE(WaitUntil([&] { return replay_.Matched() > 1 && words_.Matched() > 1; }));
  replay_.Write(ReportOf<ReplayMetrics>("replay", 0));
  words_.Write({.replay = 0, .session = 1, .stored_steps = 7});
  EXPECT_EQ(inbox.refused(), 2u);
  EXPECT_EQ(inbox_.refused(), 0u);
}

TEST_F(RunInboxTest, ProcessesThatCannotBeAreNotHeardAndCounted) {
  actor_.Write(ReportOf<ActorMetrics>("learner", 0));  // in the name of another
  actor_.Write(ReportOf<ActorMetrics>("actor", kMostActors));
  learner_.Write(ReportOf<LearnerMetrics>("learner", 1));
  replay_.Write(ReportOf<ReplayMetrics>("replay", 4'000'000'000));
  words_.Write({.replay = 3, .session = 1, .stored_steps = 1'000'000});
  EXPECT_THAT(inbox_.TakeReports(), IsEmpty());
  EXPECT_THAT(inbox_.TakeReplayProgress(), IsEmpty());
  EXPECT_EQ(inbox_.refused(), 5u);
}

}  // namespace
}  // namespace shoal::launch

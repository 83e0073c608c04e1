// SPDX-License-Identifier: Apache-2.0
#include "launch/run/candidate_checkpoints.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

EvaluationPoint Of(const std::string& checkpoint, double mean_return) {
  EvaluationPoint point;
  point.checkpoint = checkpoint;
  point.mean_return = mean_return;
  return point;
}

bool All(const std::string&) { return true; }
bool None(const std::string&) { return false; }

TEST(CandidateCheckpoints, KeepsAllCandidatesAndTheBestByReturn) {
  const auto choice =
      CandidateCheckpoints().Choose({Of("step_1", 1), Of("step_2", 3), Of("step_3", 2)}, All);
  ASSERT_TRUE(choice);
  EXPECT_THAT(choice->names, ElementsAre("step_1", "step_2", "step_3"));
  EXPECT_EQ(choice->best, "step_2");
  EXPECT_THAT(choice->lines, IsEmpty());
}

TEST(CandidateCheckpoints, AnEvaluationWithoutACheckpointKeepsNothing) {
  EXPECT_FALSE(CandidateCheckpoints().Choose({Of("step_1", 1), Of("", 2)}, All));
}

TEST(CandidateCheckpoints, ACheckpointThatWasNeverWrittenIsLeftOutAndSaidOnce) {
  CandidateCheckpoints checkpoints;
  const auto first = [](const std::string& name) { return name == "step_1"; };
  for (const bool said : {false, true}) {
    const auto choice = checkpoints.Choose({Of("step_1", 1), Of("step_2", 3)}, first);
    ASSERT_TRUE(choice);
    EXPECT_THAT(choice->names, ElementsAre("step_1"));
    EXPECT_EQ(choice->best, "step_1");
    EXPECT_EQ(choice->lines.empty(), said);
  }
}

TEST(CandidateCheckpoints, WhileTheLearnerCannotWriteItsCheckpointsAreWaitedFor) {
  CandidateCheckpoints checkpoints;
  checkpoints.OnUnwritten(2, "learner-0", "logs/learner-0.log");
  const auto waiting = checkpoints.Choose({Of("step_1", 1)}, None);
  ASSERT_TRUE(waiting);
  EXPECT_THAT(waiting->names, ElementsAre("step_1"));
  EXPECT_THAT(waiting->lines, IsEmpty());
  checkpoints.OnUnwritten(0, "learner-0", "logs/learner-0.log");
  const auto gone = checkpoints.Choose({Of("step_1", 1)}, None);
  ASSERT_TRUE(gone);
  EXPECT_THAT(gone->names, IsEmpty());
  EXPECT_THAT(gone->lines, ElementsAre("checkpoint step_1 was never written: the best is chosen "
                                       "without it"));
}

TEST(CandidateCheckpoints, SaysOnceThatTheLearnerCannotWriteAndThatItHasWritten) {
  CandidateCheckpoints checkpoints;
  EXPECT_FALSE(checkpoints.OnUnwritten(0, "learner-0", "l.log"));
  EXPECT_EQ(checkpoints.OnUnwritten(1, "learner-0", "l.log"),
            "learner-0 cannot write its checkpoints: it keeps them and tries again; why: l.log");
  EXPECT_FALSE(checkpoints.OnUnwritten(3, "learner-0", "l.log"));
  EXPECT_EQ(checkpoints.OnUnwritten(0, "learner-0", "l.log"),
            "learner-0 has written its checkpoints");
  EXPECT_FALSE(checkpoints.OnUnwritten(0, "learner-0", "l.log"));
}

}  // namespace
}  // namespace shoal::launch

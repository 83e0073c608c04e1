// SPDX-License-Identifier: Apache-2.0
#include "launch/run/evaluation_intake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/launch/evaluation_message.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class EvaluationIntakeTest : public testing::Test {
 protected:
  // The learner's word that it handed these parameters out.
  void AskFor(uint64_t env_steps, uint64_t updates) {
    word_.session = 1;
    word_.updates = updates;
    word_.env_steps = env_steps;
    word_.evaluations.push_back({updates, env_steps, "step_" + std::to_string(updates)});
    progress_.OnLearner(word_);
  }
  std::vector<uint64_t> Take(std::vector<EvalMessage> messages, seconds after = seconds(0)) {
    std::vector<uint64_t> updates;
    for (const EvalMessage& message : intake_.Take(std::move(messages), start_ + after)) {
      updates.push_back(message.version.update);
    }
    return updates;
  }

  const SteadyTime start_ = Now();
  LearnerProgress word_;
  RunProgress progress_;
  std::vector<std::string> said_;
  EvaluationIntake intake_{2, progress_,
                           [this](const std::string& line) { said_.push_back(line); }};
};

TEST_F(EvaluationIntakeTest, WhatWasAskedForCountsOnce) {
  AskFor(1000, 100);
  EXPECT_THAT(Take({EvaluationMessage(1000, 100, 0.5)}), ElementsAre(100));
  EXPECT_THAT(Take({EvaluationMessage(1000, 100, 0.5)}), IsEmpty());
  EXPECT_EQ(intake_.repeated(), 1u);
  EXPECT_EQ(intake_.refused(), 0u);
  EXPECT_THAT(said_, IsEmpty());
}

TEST_F(EvaluationIntakeTest, WhatAnEarlierSessionCountedDoesNotCountAgain) {
  AskFor(1000, 100);
  EvaluationPoint point;
  point.env_steps = 1000;
  point.updates = 100;
  intake_.Recall(point);
  EXPECT_THAT(Take({EvaluationMessage(1000, 100, 0.5)}), IsEmpty());
  EXPECT_EQ(intake_.repeated(), 1u);
}

TEST_F(EvaluationIntakeTest, OneThatIsAheadOfTheLearnersWordWaitsForIt) {
  EXPECT_THAT(Take({EvaluationMessage(1000, 100, 0.5)}), IsEmpty());
  AskFor(1000, 100);
  EXPECT_THAT(Take({}, EvaluationIntake::kWait - seconds(1)), ElementsAre(100));
  EXPECT_EQ(intake_.refused(), 0u);
}

TEST_F(EvaluationIntakeTest, OneThatNobodyAskedForIsRefusedAfterTheWait) {
  EXPECT_THAT(Take({EvaluationMessage(1000, 100, 0.5)}), IsEmpty());
  EXPECT_THAT(Take({}, EvaluationIntake::kWait), IsEmpty());
  EXPECT_EQ(intake_.refused(), 1u);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("the learner sent no such weights")));
}

TEST_F(EvaluationIntakeTest, WhatStillWaitsAtTheEndIsRefused) {
  EXPECT_THAT(Take({EvaluationMessage(1000, 100, 0.5)}), IsEmpty());
  intake_.End(start_);
  EXPECT_EQ(intake_.refused(), 1u);
  AskFor(1000, 100);
  EXPECT_THAT(Take({}), IsEmpty());
}

TEST_F(EvaluationIntakeTest, NoMoreThanSoManyWait) {
  std::vector<EvalMessage> flood;
  for (uint64_t i = 1; i <= EvaluationIntake::kMostWaiting + 5; ++i) {
    flood.push_back(EvaluationMessage(10 * i, i, 0.5));
  }
  EXPECT_THAT(Take(std::move(flood)), IsEmpty());
  EXPECT_EQ(intake_.refused(), 5u);
}

TEST_F(EvaluationIntakeTest, NonsenseIsRefusedAndSaidOncePerInterval) {
  AskFor(1000, 100);
  EvalMessage broken = EvaluationMessage(1000, 100, 0.5),
              impossible = EvaluationMessage(1000, 100, 5);
  broken.json = "{";
  EXPECT_THAT(Take({broken, impossible, EvaluationMessage(1000, 100, 0.5)}), ElementsAre(100));
  EXPECT_EQ(intake_.refused(), 2u);
  EXPECT_THAT(said_, testing::SizeIs(1));
  Take({broken}, EvaluationIntake::kSayPeriod);
  EXPECT_THAT(said_, ElementsAre(HasSubstr("(1 in all)"), HasSubstr("(3 in all)")));
}

TEST_F(EvaluationIntakeTest, TheEpisodesAreThoseOfTheConfiguration) {
  AskFor(1000, 100);
  EvaluationIntake other(3, progress_, [this](const std::string& line) { said_.push_back(line); });
  EXPECT_THAT(other.Take({EvaluationMessage(1000, 100, 0.5)}, start_), IsEmpty());
  EXPECT_THAT(said_, ElementsAre(HasSubstr("2 episodes, eval.episodes is 3")));
}

}  // namespace
}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_decisions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;

const SteadyTime kRunStart = SteadyTime() + seconds(1000);

DownProcess DownOf(const std::string& name, const std::string& hopeless = "") {
  return {.name = name,
          .reason = "exit code 1",
          .deaths = 1,
          .restart_in = seconds(5),
          .hopeless = hopeless};
}

EvaluationPoint EvaluatedAt(uint64_t env_steps, uint64_t updates, double success,
                            double mean_return) {
  EvaluationPoint point;
  point.env_steps = env_steps;
  point.updates = updates;
  point.success = success;
  point.mean_return = mean_return;
  point.episodes = 50;
  point.checkpoint = "step_" + std::to_string(updates);
  return point;
}

LearnerProgress Learned(uint64_t updates, bool drained, std::vector<uint64_t> evaluations) {
  LearnerProgress progress{.session = 1, .updates = updates, .drained = drained};
  for (const uint64_t update : evaluations) {
    EvaluationRequest& request = progress.evaluations.emplace_back();
    request.update = update;
  }
  return progress;
}

// A run of two actors that ends at 1000 env steps or at 90 % success in one evaluation.
class RunDecisionsTest : public testing::Test {
 protected:
  RunDecisionsTest() {
    config_.actors = 2;
    config_.env_steps = 1000;
    config_.stop.success = 0.9;
    config_.stop.evaluations = 1;
    config_.stop.without_actors = 60;
    config_.replay.min_size = 300;
  }

  // The object under test: made at its first use, so that a test may change what precedes it.
  RunDecisions& Run() {
    if (!run_) run_.emplace(config_, link::RunTopology(config_), before_, kRunStart);
    return *run_;
  }
  void Store(uint64_t env_steps) {
    Run().OnReplay(
        {.replay = 0, .session = 1, .stored_steps = env_steps, .stored_records = env_steps});
  }
  bool Started(const std::set<std::string>& reported) {
    return Run().Started([&](const ProcessName& name) { return reported.contains(name.Text()); });
  }

  Config config_;
  RunMeta before_;

 private:
  std::optional<RunDecisions> run_;
};

// ---- The end

TEST_F(RunDecisionsTest, ARunGoesOnUntilSomethingEndsIt) {
  EXPECT_FALSE(Run().MustEnd(/*interrupted=*/false));
  Store(999);
  Run().OnEvaluation(EvaluatedAt(900, 90, 0.5, 1));
  EXPECT_FALSE(Run().MustEnd(false));
}

TEST_F(RunDecisionsTest, TheBudgetEndsARun) {
  Store(1000);
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kBudget);
}

TEST_F(RunDecisionsTest, EarlierSessionsCountForTheBudget) {
  before_.env_steps = 1000;
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kBudget);
}

TEST_F(RunDecisionsTest, AGreaterBudgetKeepsARunGoing) {
  Store(1000);
  config_.env_steps = 2000;
  Run().Change(config_);
  EXPECT_FALSE(Run().MustEnd(false));
}

TEST_F(RunDecisionsTest, TheTargetEndsARunAndComesBeforeTheBudget) {
  Store(1000);
  Run().OnEvaluation(EvaluatedAt(900, 90, 0.96, 1));
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kTarget);
}

TEST_F(RunDecisionsTest, AnEvaluationOfAnEarlierSessionCountsForTheTarget) {
  Run().Recall(EvaluatedAt(900, 90, 0.96, 1));
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kTarget);
}

TEST_F(RunDecisionsTest, ASignalAndACommandInterruptARunAtItsTarget) {
  Run().OnEvaluation(EvaluatedAt(900, 90, 0.96, 1));
  EXPECT_EQ(Run().MustEnd(/*interrupted=*/true), RunEnd::kInterrupted);
  Run().OnStopCommand();
  EXPECT_EQ(Run().MustEnd(/*interrupted=*/false), RunEnd::kInterrupted);
}

TEST_F(RunDecisionsTest, AFailureComesBeforeEverythingElse) {
  Run().OnStopCommand();
  Run().Fail("no space left");
  EXPECT_EQ(Run().MustEnd(true), RunEnd::kFailed);
  EXPECT_EQ(Run().error(), "no space left");
}

TEST_F(RunDecisionsTest, OnlyTheFirstFailureIsSaidAndKept) {
  EXPECT_EQ(Run().Fail("the cause"), "error: the cause");
  EXPECT_FALSE(Run().Fail("a consequence"));
  EXPECT_EQ(Run().error(), "the cause");
}

TEST_F(RunDecisionsTest, SaysWhyItEnds) {
  EXPECT_THAT(*Run().BeginEnd(RunEnd::kTarget), HasSubstr("stop.success"));
  EXPECT_THAT(*Run().BeginEnd(RunEnd::kBudget), HasSubstr("budget (env_steps) is spent"));
  EXPECT_THAT(*Run().BeginEnd(RunEnd::kInterrupted), HasSubstr("Ctrl-C again"));
  Run().OnStopCommand();
  EXPECT_THAT(*Run().BeginEnd(RunEnd::kInterrupted), HasSubstr("as commanded"));
  EXPECT_FALSE(Run().BeginEnd(RunEnd::kFailed)) << "the failure was said";
}

TEST_F(RunDecisionsTest, AFailureWhileItStopsIsTheRecordedEnd) {
  Run().BeginEnd(RunEnd::kBudget);
  EXPECT_EQ(Run().end(), RunEnd::kBudget);
  EXPECT_EQ(Run().FinalEnd(), RunEnd::kBudget);
  Run().Fail("records are gone");
  EXPECT_EQ(Run().end(), RunEnd::kBudget);
  EXPECT_EQ(Run().FinalEnd(), RunEnd::kFailed);
  EXPECT_STREQ(ToString(Run().FinalEnd()), "failed");
}

TEST_F(RunDecisionsTest, ARunThatStopsTakesNoMoreCommands) {
  EXPECT_TRUE(Run().TakesCommands());
  Run().OnStopCommand();
  EXPECT_FALSE(Run().TakesCommands());
}

TEST_F(RunDecisionsTest, ARunThatEndsByItselfTakesNoMoreCommands) {
  Run().BeginEnd(RunEnd::kTarget);
  EXPECT_FALSE(Run().TakesCommands());
}

// ---- Actors that do not work

TEST_F(RunDecisionsTest, ARunWithoutActorsFailsAfterItsPatience) {
  const RoleStanding none{
      .processes = 2, .working = 0, .down = {DownOf("actor-0"), DownOf("actor-1")}};
  SteadyTime now = kRunStart;
  for (; now - kRunStart < seconds(60); now += seconds(1)) {
    EXPECT_FALSE(Run().OnStandings(none, {}, now));
  }
  std::optional<std::string> line;
  for (int i = 0; i < 5 && !line; ++i) line = Run().OnStandings(none, {}, now += seconds(1));
  ASSERT_TRUE(line);
  EXPECT_THAT(*line, HasSubstr("error: no training actor has worked for 60 s"));
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kFailed);
}

TEST_F(RunDecisionsTest, ARunWhoseEvaluationActorCannotWorkFailsBeforeItsFirstEvaluation) {
  const RoleStanding in_vain{
      .processes = 1, .working = 0, .down = {DownOf("eval-0", "exit code 2")}};
  const auto line = Run().OnStandings({}, in_vain, kRunStart);
  EXPECT_EQ(line, "error: eval-0: exit code 2");
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kFailed);
}

TEST_F(RunDecisionsTest, AnEvaluationOfThisSessionShowsThatTheEvaluationActorCanWork) {
  const RoleStanding in_vain{
      .processes = 1, .working = 0, .down = {DownOf("eval-0", "exit code 2")}};
  Run().OnEvaluation(EvaluatedAt(100, 10, 0.1, 1));
  EXPECT_FALSE(Run().OnStandings({}, in_vain, kRunStart));
}

TEST_F(RunDecisionsTest, AnEvaluationOfAnEarlierSessionDoesNot) {
  const RoleStanding in_vain{
      .processes = 1, .working = 0, .down = {DownOf("eval-0", "exit code 2")}};
  Run().Recall(EvaluatedAt(100, 10, 0.1, 1));
  EXPECT_TRUE(Run().OnStandings({}, in_vain, kRunStart));
}

TEST_F(RunDecisionsTest, ShowsWhichActorsAreDownUntilTheRunEnds) {
  Run().OnStandings({.processes = 2, .working = 1, .down = {DownOf("actor-1")}}, {}, kRunStart);
  EXPECT_EQ(Run().ActorsWorking(), 1);
  EXPECT_THAT(Run().Trouble(), HasSubstr("actors 1 of 2: actor-1: exit code 1"));
  Run().BeginEnd(RunEnd::kBudget);
  EXPECT_EQ(Run().ActorsWorking(), 2);
  EXPECT_EQ(Run().Trouble(), "");
}

// ---- The start

TEST_F(RunDecisionsTest, ARunHasStartedOnceEveryProcessHasReported) {
  EXPECT_FALSE(Started({}));
  EXPECT_FALSE(Started({"replay-0", "learner-0", "actor-0", "actor-1"}));
  EXPECT_TRUE(Started({"replay-0", "learner-0", "actor-0", "actor-1", "eval-0"}));
}

TEST_F(RunDecisionsTest, ARunOnPolicyStartsWithoutAReplay) {
  config_.learner.algorithm = "ppo";
  EXPECT_TRUE(Started({"learner-0", "actor-0", "actor-1", "eval-0"}));
}

TEST_F(RunDecisionsTest, AnActorThatWasScaledAwayIsNotWaitedFor) {
  const std::set<std::string> all_but_one{"replay-0", "learner-0", "actor-0", "eval-0"};
  EXPECT_FALSE(Started(all_but_one));
  config_.actors = 1;
  Run().Change(config_);
  EXPECT_TRUE(Started(all_but_one));
}

TEST_F(RunDecisionsTest, AnActorThatIsDownIsNotWaitedForWhileAnotherWorks) {
  const std::set<std::string> all_but_one{"replay-0", "learner-0", "actor-0", "eval-0"};
  Run().OnStandings({.processes = 2, .working = 0, .down = {DownOf("actor-1")}}, {}, kRunStart);
  EXPECT_FALSE(Started(all_but_one));
  Run().OnStandings({.processes = 2, .working = 1, .down = {DownOf("actor-1")}}, {}, kRunStart);
  EXPECT_TRUE(Started(all_but_one));
}

// ---- Draining

TEST_F(RunDecisionsTest, ActorsDrainOnlyWhileAReplayRuns) {
  EXPECT_TRUE(Run().CanDrain(/*running_replays=*/1));
  EXPECT_FALSE(Run().CanDrain(0));
}

TEST_F(RunDecisionsTest, OnPolicyActorsDrainWithoutAReplay) {
  config_.learner.algorithm = "ppo";
  EXPECT_TRUE(Run().CanDrain(0));
}

TEST_F(RunDecisionsTest, AfterTheBudgetTheLearnerFinishesAndTheLastEvaluationArrives) {
  Run().BeginEnd(RunEnd::kBudget);
  Run().OnLearner(Learned(80, /*drained=*/false, {}));
  EXPECT_FALSE(Run().Settled());
  Run().OnLearner(Learned(100, /*drained=*/true, {90, 100}));
  EXPECT_FALSE(Run().Settled());
  Run().OnEvaluation(EvaluatedAt(900, 90, 0.1, 1));
  EXPECT_FALSE(Run().Settled());
  Run().OnEvaluation(EvaluatedAt(1000, 100, 0.1, 1));
  EXPECT_TRUE(Run().Settled());
}

TEST_F(RunDecisionsTest, ARunThatHandedOutNoEvaluationWaitsForNone) {
  Run().BeginEnd(RunEnd::kBudget);
  Run().OnLearner(Learned(100, /*drained=*/true, {}));
  EXPECT_TRUE(Run().Settled());
}

TEST_F(RunDecisionsTest, AfterAnyOtherEndTheLearnerMayStopAtOnce) {
  for (const RunEnd end : {RunEnd::kTarget, RunEnd::kInterrupted, RunEnd::kFailed}) {
    Run().BeginEnd(end);
    EXPECT_TRUE(Run().Settled()) << ToString(end);
  }
}

TEST_F(RunDecisionsTest, InLockstepTheTargetIsPlayedToTheEndToo) {
  config_.lockstep = true;
  config_.actors = 1;
  Run().BeginEnd(RunEnd::kTarget);
  EXPECT_FALSE(Run().Settled());
  Run().BeginEnd(RunEnd::kInterrupted);
  EXPECT_TRUE(Run().Settled());
}

// Without a replay a dead learner's successor goes on from a checkpoint, with fewer env steps.
TEST_F(RunDecisionsTest, ADeadLearnersCountOnPolicyEndsNoRun) {
  config_.learner.algorithm = "ppo";
  Run().OnLearner({.session = 1, .env_steps = 1000});
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kBudget);
  Run().OnLearnerDeath();
  EXPECT_FALSE(Run().MustEnd(false));
  Run().OnLearner({.session = 1, .env_steps = 1000});
  EXPECT_FALSE(Run().MustEnd(false)) << "a message that came late";
  Run().OnLearner({.session = 2, .env_steps = 900});
  EXPECT_FALSE(Run().MustEnd(false));
  Run().OnLearner({.session = 2, .env_steps = 1020});
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kBudget);
}

TEST_F(RunDecisionsTest, WithAReplayTheStoredStepsCountWhateverTheLearnerDoes) {
  Store(1000);
  Run().OnLearnerDeath();
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kBudget);
}

TEST_F(RunDecisionsTest, ALearnerThatTakesStepsWithItAfterTheEndFailsTheRun) {
  config_.learner.algorithm = "ppo";
  Run().OnLearner({.session = 1, .env_steps = 1000});
  Run().BeginEnd(RunEnd::kBudget);
  EXPECT_FALSE(Run().OnEnded());
  EXPECT_EQ(Run().FinalEnd(), RunEnd::kBudget);
  Run().OnLearner({.session = 2, .env_steps = 900});
  EXPECT_THAT(Run().OnEnded().value_or(""), HasSubstr("900 of 1000 env steps"));
  EXPECT_EQ(Run().FinalEnd(), RunEnd::kFailed);
}

// ---- The run so far

TEST_F(RunDecisionsTest, EnvStepsAndUpdatesNeverFallBelowThoseOfEarlierSessions) {
  before_.env_steps = 500;
  before_.updates = 40;
  EXPECT_EQ(Run().env_steps(), 500u);
  EXPECT_EQ(Run().updates(), 40u);
  Store(400);
  EXPECT_EQ(Run().env_steps(), 500u);
  Store(600);
  EXPECT_EQ(Run().env_steps(), 600u);
  Run().OnLearner(Learned(35, false, {}));
  EXPECT_EQ(Run().updates(), 35u) << "the learner goes on from its checkpoint";
}

TEST_F(RunDecisionsTest, SaysThatAReplayLostWhatItHeld) {
  EXPECT_FALSE(
      Run().OnReplay({.replay = 0, .session = 1, .stored_steps = 400, .stored_records = 450}));
  const auto line =
      Run().OnReplay({.replay = 0, .session = 2, .stored_steps = 0, .stored_records = 0});
  ASSERT_TRUE(line);
  EXPECT_THAT(*line, HasSubstr("replay-0 starts empty, env steps continue from 400"));
  EXPECT_THAT(*line, HasSubstr("holds 300 sampleable"));
}

TEST_F(RunDecisionsTest, RemembersTheLastTheBestAndTheFirstGoodEvaluation) {
  config_.stop.success = 2;  // never stops at it
  EXPECT_FALSE(Run().best());
  EXPECT_TRUE(Run().OnEvaluation(EvaluatedAt(100, 10, 0.1, 1)).best);
  EXPECT_TRUE(Run().OnEvaluation(EvaluatedAt(200, 20, 1.0, 9)).best);
  EXPECT_FALSE(Run().OnEvaluation(EvaluatedAt(300, 30, 0.2, 2)).best);
  EXPECT_EQ(Run().last_evaluation()->updates, 30u);
  EXPECT_EQ(Run().best()->updates, 20u);
  ASSERT_EQ(Run().candidates().size(), 1u);
  EXPECT_EQ(Run().candidates()[0].checkpoint, "step_20");
  ASSERT_TRUE(Run().first_success());
  EXPECT_EQ(Run().first_success()->updates, 20u);
}

TEST_F(RunDecisionsTest, AnotherTargetJudgesFormerEvaluationsAgain) {
  Run().OnEvaluation(EvaluatedAt(100, 10, 0.8, 1));
  EXPECT_FALSE(Run().first_success());
  config_.stop.success = 0.7;
  Run().Change(config_);
  EXPECT_EQ(Run().target(), 0.7);
  EXPECT_TRUE(Run().first_success());
  EXPECT_EQ(Run().MustEnd(false), RunEnd::kTarget);
}

TEST_F(RunDecisionsTest, WarnsOnceOfAScoreThatStaysFlat) {
  int warnings = 0;
  for (uint64_t i = 1; i <= 2 * FlatScore::kWindow; ++i) {
    if (Run().OnEvaluation(EvaluatedAt(100 * i, 10 * i, 0.1, 1)).warning) ++warnings;
  }
  EXPECT_EQ(warnings, 1);
}

}  // namespace
}  // namespace shoal::launch

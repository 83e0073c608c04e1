// SPDX-License-Identifier: Apache-2.0
#include "launch/run/core_split.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// A run whose processes have the costs of the model, with updates multiplied by `update_factor`.
class ModelRun {
 public:
  explicit ModelRun(const CoreCosts& costs, const Split& split) : costs_(costs), split_(split) {}

  // Simulates this number of seconds, with one Look per second.
  std::vector<CoreSplit::Move> Run(CoreSplit& division, double seconds) {
    std::vector<CoreSplit::Move> moves;
    for (double end = seconds_ + seconds; seconds_ < end; ++seconds_) {
      if (const auto move = division.Look(seconds_, counts_, costs_.updates_per_env_step)) {
        moves.push_back(*move);
        moved_at_.push_back(seconds_);
        split_ = move->to;
      }
      Advance();
    }
    return moves;
  }
  double Pace() const { return PaceNow(); }
  const Split& split() const { return split_; }
  const std::vector<double>& moved_at() const { return moved_at_; }

  // An update's time as a multiple of the model's, by the number of threads.
  std::function<double(int)> update_factor = [](int) { return 1.0; };
  double starts_learning_at = 0;
  double idle = 0;  // share of the time in which both sides wait, in every division

 private:
  double UpdatesNow() const {
    return UpdatesPerSecond(costs_, split_.threads) / update_factor(split_.threads);
  }
  double PaceNow() const {
    return (1 - idle) *
           std::min(split_.actors / costs_.env_step, UpdatesNow() / costs_.updates_per_env_step);
  }
  void Advance() {
    const double pace = PaceNow(), updates = pace * costs_.updates_per_env_step;
    counts_.learner_seconds += 1;
    counts_.actor_seconds += split_.actors;
    if (seconds_ < starts_learning_at) {  // no actor waits for the learner yet
      counts_.env_steps += split_.actors / costs_.env_step;
      counts_.learner_waited += 1;
      return;
    }
    counts_.env_steps += pace;
    counts_.updates += updates;
    counts_.actors_waited += split_.actors - pace * costs_.env_step;
    counts_.learner_waited += 1 - updates / UpdatesNow();
    counts_.servers_cpu_seconds += pace * costs_.servers;
  }

  const CoreCosts costs_;
  Split split_;
  double seconds_ = 0;
  SplitCounts counts_;
  std::vector<double> moved_at_;
};

CoreCosts Flagship() {
  return {.env_step = 2e-3, .update = 26e-3, .updates_per_env_step = 0.125, .servers = 0.4e-3};
}
constexpr SplitLimits kSixteen{.cores = 16, .most_threads = 16};

TEST(CoreSplit, ABadFirstGuessIsMovedToTheBestDivisionInOneMove) {
  const Split guess{.actors = 12, .threads = 4};
  CoreSplit division(kSixteen, guess);
  ModelRun run(Flagship(), guess);
  const double before = run.Pace();
  const auto moves = run.Run(division, 60);
  ASSERT_THAT(moves, SizeIs(1));
  EXPECT_EQ(run.split(), BestSplit(Flagship(), kSixteen));
  EXPECT_GT(run.Pace(), 1.9 * before);
  EXPECT_TRUE(division.done());
  EXPECT_THAT(moves[0].line,
              HasSubstr("16 cores: 10 learner threads and 6 actors from now on, 4 learner threads "
                        "and 12 actors before; an update took"));
  EXPECT_LT(run.moved_at()[0], 8);
}

TEST(CoreSplit, AGoodFirstGuessStays) {
  const Split guess = BestSplit(Flagship(), kSixteen);
  CoreSplit division(kSixteen, guess);
  ModelRun run(Flagship(), guess);
  EXPECT_THAT(run.Run(division, 60), IsEmpty());
  EXPECT_TRUE(division.done());
}

// The model has no such waits: beside the measured pace, another division would always seem faster.
TEST(CoreSplit, WaitsThatEveryDivisionHasPromiseNoGain) {
  Split guess = BestSplit(Flagship(), kSixteen);
  ++guess.actors;
  CoreSplit division(kSixteen, guess);
  ModelRun run(Flagship(), guess);
  run.idle = 0.2;
  EXPECT_THAT(run.Run(division, 60), IsEmpty());
  EXPECT_TRUE(division.done());
}

TEST(CoreSplit, TooFewActorsAreMoreAfterwards) {
  const Split guess{.actors = 1, .threads = 10};
  CoreSplit division(kSixteen, guess);
  ModelRun run(Flagship(), guess);
  EXPECT_THAT(run.Run(division, 60), SizeIs(1));
  EXPECT_EQ(run.split(), BestSplit(Flagship(), kSixteen));
}

// Cores that two hardware threads share: beyond eight, threads slow each other down.
TEST(CoreSplit, AMoveThatMadeTheRunSlowerIsTakenBack) {
  const Split guess{.actors = 4, .threads = 8};
  CoreSplit division(kSixteen, guess);
  ModelRun run(Flagship(), guess);
  run.update_factor = [](int threads) { return threads > 8 ? 2.0 : 1.0; };
  const auto moves = run.Run(division, 60);
  ASSERT_THAT(moves, SizeIs(2));
  EXPECT_GT(moves[0].to.threads, 8);
  EXPECT_EQ(moves[1].to, guess);
  EXPECT_THAT(moves[1].line, HasSubstr("back to 8 learner threads and 4 actors"));
  EXPECT_TRUE(division.done());
}

TEST(CoreSplit, ItKeepsStillTwentySecondsAfterTheFirstUpdate) {
  for (const double start : {0.0, 40.0}) {
    const Split guess{.actors = 12, .threads = 4};
    CoreSplit division(kSixteen, guess);
    ModelRun run(Flagship(), guess);
    run.starts_learning_at = start;
    // Never the same twice: there would always be something to gain.
    int call = 0;
    run.update_factor = [&call](int) { return 1.0 + (++call % 7); };
    run.Run(division, start + 60);
    EXPECT_LE(run.moved_at().size(), CoreSplit::kMostMoves);
    for (const double at : run.moved_at()) {
      EXPECT_GE(at, start);
      EXPECT_LE(at, start + CoreSplit::kLast + CoreSplit::kMeasured + 1);
    }
    EXPECT_TRUE(division.done());
  }
}

TEST(CoreSplit, UpdatesTooFewToMeasureMoveNothing) {
  CoreCosts slow = Flagship();
  slow.update = 30;  // seconds
  slow.updates_per_env_step = 1;
  CoreSplit division(kSixteen, {.actors = 8, .threads = 1});
  ModelRun run(slow, {.actors = 8, .threads = 1});
  EXPECT_THAT(run.Run(division, 60), IsEmpty());
  EXPECT_TRUE(division.done());
}

// The tenth update arrives at the twentieth second, too late to change the division.
TEST(CoreSplit, AMeasurementThatEndsTooLateMovesNothing) {
  CoreCosts slow = Flagship();
  slow.update = 1.75;
  slow.updates_per_env_step = 0.01;
  const Split guess{.actors = 8, .threads = 1};
  CoreSplit division(kSixteen, guess);
  ModelRun run(slow, guess);
  EXPECT_THAT(run.Run(division, 60), IsEmpty());
  EXPECT_TRUE(division.done());
  EXPECT_GT(PaceOf(slow, BestSplit(slow, kSixteen)), 2 * PaceOf(slow, guess));
}

TEST(CoreSplit, GivenNumbersStay) {
  SplitLimits limits = kSixteen;
  limits.actors = 2;
  const Split guess{.actors = 2, .threads = 2};
  CoreSplit division(limits, guess);
  ModelRun run(Flagship(), guess);
  for (const auto& move : run.Run(division, 60)) EXPECT_EQ(move.to.actors, 2);
  EXPECT_GT(run.split().threads, 2);
}

TEST(CoreSplit, SomebodyElsesDecisionEndsIt) {
  const Split guess{.actors = 12, .threads = 4};
  CoreSplit division(kSixteen, guess);
  division.Stop();
  ModelRun run(Flagship(), guess);
  EXPECT_THAT(run.Run(division, 60), IsEmpty());
}

}  // namespace
}  // namespace shoal::launch

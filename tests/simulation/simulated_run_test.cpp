// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/clock.h"
#include "common/base/random.h"
#include "common/base/usable_cores.h"
#include "tests/simulation/child_runs.h"

namespace shoal::simulation {
namespace {

using std::chrono::milliseconds;
using Kind = Fault::Kind;

constexpr uint64_t kFile = 6, kMemory = 9, kPpo = 5;  // seeds of the three blueprints

const std::vector<Blueprint>& TheBlueprints() {
  static const std::vector<Blueprint> blueprints = MakeBlueprints();
  return blueprints;
}

std::vector<Fault> FaultsOf(uint64_t seed) {
  return DrawFaults(seed, BlueprintOf(seed, TheBlueprints()).run.config);
}

// The summary of a correct run; else the broken promises.
void ExpectGood(uint64_t seed, const std::vector<Fault>& faults) {
  const ChildRun run = RunInChild(TheBlueprints(), seed, faults);
  EXPECT_TRUE(run.good) << run.text << run.summary;
}

Fault At(int second, Kind kind, const std::string& process, int span = 0,
         const std::string& text = "") {
  return {.kind = kind,
          .at = milliseconds(second * 1000),
          .process = process,
          .span = milliseconds(span * 1000),
          .text = text,
          .number = 0};
}

TEST(SimulatedRun, ASeedRepeatsAndAnotherOneDiffers) {
  const auto summary = [](uint64_t seed) {
    return RunInChild(TheBlueprints(), seed, FaultsOf(seed)).summary;
  };
  const std::string first = summary(3);
  EXPECT_EQ(first, summary(3));
  EXPECT_NE(first.substr(first.find("trace")), summary(4).substr(summary(4).find("trace")));
}

TEST(SimulatedRun, EachProcessIsKilledInTheMiddleOfARun) {
  for (const char* process : {"replay-0", "learner-0", "eval-0", "actor-0", "actor-1"}) {
    for (const uint64_t seed : {kFile, kMemory}) {
      ExpectGood(seed, {At(5, Kind::kKill, process)});
    }
  }
  for (const char* process : {"learner-0", "eval-0", "actor-0"}) {
    ExpectGood(kPpo, {At(2, Kind::kKill, process)});
  }
}

TEST(SimulatedRun, ARunGoesOnAfterItsCoordinatorWasKilled) {
  for (const char* then : {kThenResume, kThenOverwrite, kThenLoseRing, kThenCutRing}) {
    for (const uint64_t seed : {kFile, kMemory, kPpo}) {
      const ChildRun run =
          RunInChild(TheBlueprints(), seed, {At(2, Kind::kKill, "coordinator", /*span=*/1, then)});
      EXPECT_TRUE(run.good) << run.text << run.summary;
      EXPECT_THAT(run.summary, testing::Not(testing::HasSubstr(" 1 session")));
    }
  }
}

TEST(SimulatedRun, EachKindOfFaultIsMet) {
  ExpectGood(kFile, {At(3, Kind::kPause, "eval-0", 8), At(5, Kind::kStall, "learner-0", 2)});
  ExpectGood(kFile, {At(3, Kind::kSlow, "replay-0", 5), At(4, Kind::kPartition, "actor-0", 8)});
  ExpectGood(kFile, {At(3, Kind::kFullDisk, "", 20)});
  ExpectGood(kFile, {At(1, Kind::kFailingDisk, "learner-0", 20)});
  ExpectGood(kFile, {At(3, Kind::kClock, "", -3600), At(4, Kind::kKill, "actor-0")});
  ExpectGood(kFile, {At(3, Kind::kCommand, "", 0, "scale 3"), At(5, Kind::kAttach, "", 3)});
  ExpectGood(kFile, {At(3, Kind::kSecond, ""), At(6, Kind::kInterrupt, "")});
}

// The run cannot end in this time, because one of its processes is paused.
TEST(SimulatedRun, AStopEndsInTimeIfItsCoordinatorDies) {
  const ChildRun run =
      RunInChild(TheBlueprints(), kFile,
                 {At(3, Kind::kPause, "learner-0", 20), At(4, Kind::kCommand, "", 0, "stop"),
                  At(5, Kind::kKill, "coordinator", /*span=*/1, kThenResume)});
  EXPECT_TRUE(run.good) << run.text << run.summary;
  EXPECT_THAT(run.text, testing::HasSubstr("shoal stop: exit code 1: accepted, but the run's "
                                           "coordinator has been silent for 15 s"));
}

TEST(SimulatedRun, SeedsThatFoundAFaultOfTheProductKeepWhatIsPromised) {
  // A disk that was full at the end of a run; --resume refused the run as finished.
  ExpectGood(1458, {At(3, Kind::kPause, "coordinator", 20), At(24, Kind::kFullDisk, "", 3)});
  // The clock was set back between an actor's start and its first record, which was refused until
  // the clock had caught up.
  ExpectGood(192871542771512, FaultsOf(192871542771512));
  // The replay died while the run stopped, was not started again, and the run called itself clean.
  ExpectGood(101768, FaultsOf(101768));
  // The simulated link took a coordinator for cut off whose predecessor had ended cut off.
  ExpectGood(100977, FaultsOf(100977));
  // The only actor died six times on a full disk before it had worked for ten seconds. The run
  // ended as its page says; the simulation took that for a fault.
  ExpectGood(502723, FaultsOf(502723));
  // The replay started on a full disk, so that its session was not stored, and again after the
  // clock was set back: its peers took it for an older one, and the run stood still.
  ExpectGood(508165, FaultsOf(508165));
  // The learner of a run on policy died as the budget was spent, and the run ended with fewer env
  // steps, for good.
  ExpectGood(523385, FaultsOf(523385));
  ExpectGood(546419, FaultsOf(546419));
  // A coordinator that was cut off ended with exit code 4. `shoal stop` took the next session for
  // its run, waited for its end and returned its exit code.
  ExpectGood(9218, FaultsOf(9218));
}

TEST(SimulatedRun, FixedSeedsKeepWhatIsPromised) {
  uint64_t seed = 0;
  RunInChildren(
      TheBlueprints(), UsableCores(), /*with_story=*/false,
      [&] { return seed < 2000 ? ++seed : 0; }, FaultsOf,
      [](const ChildRun& run) {
        EXPECT_TRUE(run.good) << run.text << run.summary << "\n  shoal-simulate --seed " << run.seed
                              << " --trace";
      });
}

// Other seeds in each run, for a minute of the machine's cores at most.
TEST(SimulatedRun, FreshSeedsKeepWhatIsPromised) {
  const uint64_t first = HashWords({static_cast<uint64_t>(WallTimeNs())}) >> 16;
  uint64_t seed = first;
  const SteadyTime start = Now();
  RunInChildren(
      TheBlueprints(), UsableCores(), /*with_story=*/false,
      [&] { return seed < first + 500 && SecondsSince(start) < 60 ? ++seed : 0; }, FaultsOf,
      [](const ChildRun& run) {
        EXPECT_TRUE(run.good) << run.text << run.summary << "\n  shoal-simulate --seed " << run.seed
                              << " --trace";
      });
}

}  // namespace
}  // namespace shoal::simulation

// SPDX-License-Identifier: Apache-2.0
// In lockstep a whole run through the real processes repeats bit for bit.
#include "common/config/lockstep.h"

#include <gtest/gtest.h>

#include "common/config/run_files.h"
#include "tests/support/running_training.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

struct Outcome {
  std::string learner, evaluations;
};

Outcome RunInLockstep(const std::string& seed, const std::string& priorities = "none") {
  const TrainingRun run;
  const ProgramResult result = run.Train({{"env_steps", "1200"},
                                          {"eval.interval", "600"},
                                          {"actors", "1"},
                                          {"seed", seed},
                                          {"replay.priorities", priorities}},
                                         {"--lockstep"});
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  Outcome outcome;
  outcome.learner = NewestLearnerState(run);
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "eval")) {
    outcome.evaluations +=
        nlohmann::json::parse(ReadFile(entry.path())).at("episodes").dump() + "\n";
  }
  return outcome;
}

// A run with these keys and flags that is interrupted and resumed at each of these env steps must
// end like the uninterrupted run `whole`.
void ExpectGoesOnBitForBit(const TrainingRun& whole, const TrainingRun::Keys& keys,
                           const std::vector<std::string>& flags,
                           const std::vector<int64_t>& interrupts) {
  const ProgramResult result = whole.Train(keys, flags);
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto meta = whole.Json("meta.json");
  const TrainingRun interrupted;
  std::vector<std::string> command = interrupted.Command(keys, flags);
  for (const int64_t steps : interrupts) {
    RunningTraining training(interrupted, command);
    ASSERT_TRUE(training.WaitForSteps(steps)) << training.Output();
    training.Interrupt();
    ASSERT_EQ(training.End(std::chrono::seconds(120)), kInterruptedExit) << training.Output();
    ASSERT_LT(interrupted.Json("meta.json").at("env_steps").get<int64_t>(),
              meta.at("env_steps").get<int64_t>())
        << "ended before it was interrupted";
    command = {"shoal", "train", "--resume", interrupted.path().string()};
  }
  RunningTraining last(interrupted, command);
  ASSERT_EQ(last.End(std::chrono::seconds(180)), 0) << last.Output();
  const auto other = interrupted.Json("meta.json");
  EXPECT_EQ(meta.at("env_steps"), other.at("env_steps"));
  EXPECT_EQ(meta.at("updates"), other.at("updates"));
  EXPECT_GT(meta.at("updates").get<int64_t>(), 20);
  ExpectBalanced(other);
  EXPECT_TRUE(NewestLearnerState(whole) == NewestLearnerState(interrupted))
      << "learner.safetensors differs";
}

TEST(Lockstep, AnInterruptedRunGoesOnBitForBit) {
  const TrainingRun whole;
  // Twice: where the learner has hardly begun, and later.
  ExpectGoesOnBitForBit(whole, {{"env_steps", "6000"}, {"actors", "1"}, {"eval.interval", "2000"}},
                        {"--lockstep"}, {1030, 3000});
}

TEST(Lockstep, RunningStatisticsRepeatAndGoOnBitForBit) {
  const TrainingRun whole;
  ExpectGoesOnBitForBit(whole,
                        TrainingRun::FromPixels({{"actors", "1"},
                                                 {"env_steps", "192"},
                                                 {"learner.batch", "4"},
                                                 {"network.encoder", "resnet18"},
                                                 {"observation.cameras", R"(["front"])"},
                                                 {"observation.height", "24"},
                                                 {"observation.width", "24"}}),
                        {"--lockstep"}, {130});
  EXPECT_NE(NewestLearnerState(whole).find("encoder.bn1.running_mean"), std::string::npos);
}

// The updates of the whole run equal the sum over the env steps after phase 0.
TEST(Lockstep, AScheduleOfSamplesGoesOnBitForBitAndEndsWhereItShould) {
  const TrainingRun whole;
  ExpectGoesOnBitForBit(whole,
                        {{"env_steps", "6000"},
                         {"actors", "1"},
                         {"eval.interval", "2000"},
                         {"replay.samples_per_insert", "linear(8,32,4000)"}},
                        {"--lockstep"}, {2000});
  const Config config = ReadRunConfig(whole.path()).config;
  const auto samples_at = [](double x) { return x < 4000 ? 8 + 24 * x / 4000 : 32; };
  const auto meta = whole.Json("meta.json");
  const int64_t end = meta.at("env_steps").get<int64_t>();
  const int64_t envs = config.envs_per_actor, phase = config.lockstep_steps * envs;
  int64_t step = (config.replay.min_size + phase - 1) / phase * phase;
  double granted = 0;
  for (; step < end; ++step) granted += samples_at(static_cast<double>(step) + 0.5);
  EXPECT_EQ(meta.at("updates").get<int64_t>(),
            static_cast<int64_t>(granted / config.learner.batch + 1e-6));
  EXPECT_EQ(meta.at("updates").get<uint64_t>(), LockstepLastUpdate(config));
}

// Goal pictures are separate records, and relabelled goals are frames of stored episodes. Steps are
// reported once per second, so the rest of the run after the interrupt must take seconds.
TEST(Lockstep, HindsightWithPicturesOfGoalsGoesOnBitForBit) {
  const TrainingRun whole;
  ExpectGoesOnBitForBit(whole,
                        TrainingRun::FromPixels({{"actors", "1"},
                                                 {"env_steps", "2400"},
                                                 {"eval.interval", "1200"},
                                                 {"observation.cameras", R"(["front"])"},
                                                 {"observation.goal_mode", "image"},
                                                 {"observation.height", "36"},
                                                 {"observation.width", "36"},
                                                 {"replay.min_size", "200"},
                                                 {"replay.movement_share", "0.5"},
                                                 {"replay.samples_per_insert", "16"}}),
                        {"--preset", "fetch-reach-her", "--lockstep"}, {450});
}

// Updates copy networks in periods, and both sides of the interrupt are in the middle of one.
TEST(Lockstep, ALatentModelGoesOnBitForBit) {
  const TrainingRun whole;
  ExpectGoesOnBitForBit(whole,
                        TrainingRun::FromPixels({{"actors", "1"},
                                                 {"env_steps", "2400"},
                                                 {"eval.interval", "1200"},
                                                 {"mrq.horizon", "2"},
                                                 {"mrq.period", "70"},
                                                 {"observation.cameras", R"(["front"])"},
                                                 {"observation.height", "24"},
                                                 {"observation.width", "24"},
                                                 {"replay.priorities", "none"},
                                                 {"replay.priority_exponent", "0.6"},
                                                 {"replay.samples_per_insert", "8"},
                                                 {"task", "FetchReachDense"}}),
                        {"--preset", "state-mrq", "--lockstep"}, {450});
  EXPECT_NE(NewestLearnerState(whole).find("held.heads.weight"), std::string::npos);
}

TEST(Lockstep, TheSameSeedGivesTheSameBytes) {
  const Outcome first = RunInLockstep("5"), again = RunInLockstep("5"), other = RunInLockstep("6");
  EXPECT_FALSE(first.learner.empty());
  EXPECT_TRUE(first.learner == again.learner) << "learner.safetensors differs";
  EXPECT_EQ(first.evaluations, again.evaluations);
  EXPECT_FALSE(first.learner == other.learner) << "the seed has no effect";
}

TEST(Lockstep, PrioritiesRepeatBitForBit) {
  for (const char* kind : {"proportional", "lap"}) {
    const Outcome first = RunInLockstep("5", kind), again = RunInLockstep("5", kind);
    EXPECT_FALSE(first.learner.empty());
    EXPECT_TRUE(first.learner == again.learner) << "learner.safetensors differs";
    EXPECT_FALSE(first.learner == RunInLockstep("5").learner) << kind << " has no effect";
  }
}

}  // namespace
}  // namespace shoal

// In lockstep a whole run through the real processes repeats bit for bit.
#include <gtest/gtest.h>

#include "tests/support/running_training.h"
#include "tests/support/training_run.h"

namespace shoal {
namespace {

struct Outcome {
  std::string learner, evaluations;
};

// learner.safetensors of the newest checkpoint.
std::string LearnerOf(const TrainingRun& run) {
  std::filesystem::path newest;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "checkpoints")) {
    if (entry.path().filename() != "best") newest = std::max(newest, entry.path());
  }
  return ReadFile(newest / "learner.safetensors");
}

Outcome RunInLockstep(const std::string& seed) {
  const TrainingRun run;
  const ProgramResult result =
      run.Train({{"env_steps", "1200"}, {"eval.interval", "600"}, {"actors", "1"}, {"seed", seed}},
                {"--lockstep"});
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  Outcome outcome;
  outcome.learner = LearnerOf(run);
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "eval")) {
    outcome.evaluations +=
        nlohmann::json::parse(ReadFile(entry.path())).at("episodes").dump() + "\n";
  }
  return outcome;
}

TEST(Lockstep, AnInterruptedRunGoesOnBitForBit) {
  const TrainingRun::Keys keys{{"env_steps", "6000"}, {"actors", "1"}, {"eval.interval", "2000"}};
  const TrainingRun whole, interrupted;
  const ProgramResult result = whole.Train(keys, {"--lockstep"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  // Twice: where the learner has hardly begun, and later.
  std::vector<std::string> command = interrupted.Command(keys, {"--lockstep"});
  for (const int64_t steps : {1030, 3000}) {
    RunningTraining training(interrupted, command);
    ASSERT_TRUE(training.WaitForSteps(steps)) << training.Output();
    training.Interrupt();
    ASSERT_EQ(training.End(std::chrono::seconds(120)), kInterruptedExit) << training.Output();
    ASSERT_LT(interrupted.Json("meta.json").at("env_steps").get<int64_t>(), 6000)
        << "ended before it was interrupted";
    command = {"shoal", "train", "--resume", interrupted.path().string()};
  }
  RunningTraining last(interrupted, command);
  ASSERT_EQ(last.End(std::chrono::seconds(180)), 0) << last.Output();
  const auto one = whole.Json("meta.json"), other = interrupted.Json("meta.json");
  EXPECT_EQ(one.at("env_steps"), other.at("env_steps"));
  EXPECT_EQ(one.at("updates"), other.at("updates"));
  EXPECT_GT(one.at("updates").get<int64_t>(), 50);
  ExpectBalanced(other);
  EXPECT_TRUE(LearnerOf(whole) == LearnerOf(interrupted)) << "learner.safetensors differs";
}

TEST(Lockstep, RunningStatisticsRepeatAndGoOnBitForBit) {
  const TrainingRun::Keys keys = TrainingRun::FromPixels({{"actors", "1"},
                                                          {"env_steps", "352"},
                                                          {"learner.batch", "4"},
                                                          {"network.encoder", "resnet18"},
                                                          {"observation.cameras", R"(["front"])"},
                                                          {"observation.height", "24"},
                                                          {"observation.width", "24"}});
  const TrainingRun whole, interrupted;
  const ProgramResult result = whole.Train(keys, {"--lockstep"});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  RunningTraining first(interrupted, interrupted.Command(keys, {"--lockstep"}));
  ASSERT_TRUE(first.WaitForSteps(130)) << first.Output();
  first.Interrupt();
  ASSERT_EQ(first.End(std::chrono::seconds(120)), kInterruptedExit) << first.Output();
  const auto steps = interrupted.Json("meta.json").at("env_steps").get<int64_t>();
  ASSERT_LT(steps, 352) << "ended before it was interrupted";
  RunningTraining rest(interrupted, {"shoal", "train", "--resume", interrupted.path().string()});
  ASSERT_EQ(rest.End(std::chrono::seconds(180)), 0) << rest.Output();
  const std::string learner = LearnerOf(whole);
  EXPECT_NE(learner.find("encoder.bn1.running_mean"), std::string::npos);
  EXPECT_TRUE(learner == LearnerOf(interrupted)) << "learner.safetensors differs";
}

TEST(Lockstep, TheSameSeedGivesTheSameBytes) {
  const Outcome first = RunInLockstep("5"), again = RunInLockstep("5"), other = RunInLockstep("6");
  EXPECT_FALSE(first.learner.empty());
  EXPECT_TRUE(first.learner == again.learner) << "learner.safetensors differs";
  EXPECT_EQ(first.evaluations, again.evaluations);
  EXPECT_FALSE(first.learner == other.learner) << "the seed has no effect";
}

}  // namespace
}  // namespace shoal

// In lockstep a whole run through the real processes repeats bit for bit.
#include <gtest/gtest.h>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

struct Outcome {
  std::string learner, evaluations;
};

Outcome RunInLockstep(const std::string& seed) {
  const TrainingRun run;
  const ProgramResult result =
      run.Train({{"env_steps", "1200"}, {"eval.interval", "600"}, {"actors", "1"}, {"seed", seed}},
                {"--lockstep"});
  EXPECT_EQ(ExitCode(result), 0) << result.out << result.err;
  Outcome outcome;
  std::filesystem::path newest;
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "checkpoints")) {
    if (entry.path().filename() != "best") newest = std::max(newest, entry.path());
  }
  outcome.learner = ReadFile(newest / "learner.safetensors");
  for (const auto& entry : std::filesystem::directory_iterator(run.path() / "eval")) {
    outcome.evaluations +=
        nlohmann::json::parse(ReadFile(entry.path())).at("episodes").dump() + "\n";
  }
  return outcome;
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

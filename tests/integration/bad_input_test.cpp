// Every wrong thing a user can say gets one clear line that names it, and the right exit code.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/training_run.h"

namespace shoal {
namespace {

struct Mistake {
  std::string name;
  std::vector<std::string> command;
  int exit_code;
  std::vector<std::string> mentions;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class BadInput : public testing::TestWithParam<Mistake> {};

TEST_P(BadInput, GetsOneLineThatNamesIt) {
  const ProgramResult result = RunProgram(GetParam().command, std::chrono::seconds(30));
  EXPECT_EQ(ExitCode(result), GetParam().exit_code) << result.out << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  for (const std::string& word : GetParam().mentions) {
    EXPECT_NE(result.err.find(word), std::string::npos) << "no '" << word << "' in " << result.err;
  }
}

std::vector<std::string> TrainWith(const std::string& assignment) {
  return {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set", assignment};
}

INSTANTIATE_TEST_SUITE_P(
    All, BadInput,
    testing::Values(
        Mistake{"UnknownKey", TrainWith("learner.bach=3"), 2, {"learner.bach", "learner.batch"}},
        Mistake{"KeyOfTwoLines", TrainWith("learner.\nbatch=3"), 2, {"learner. batch"}},
        Mistake{"ShiftsOfNoCopies",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "replay.target_shifts=2"},
                2,
                {"replay.target_shifts = 2", "replay.copies = 1"}},
        Mistake{"IllTyped", TrainWith("learner.batch=many"), 2, {"learner.batch", "many"}},
        Mistake{"OutOfRange", TrainWith("learner.batch=-1"), 2, {"learner.batch", "-1"}},
        Mistake{"FewerGoalsOfHindsightThanNone",
                TrainWith("replay.hindsight_goals=-1"),
                2,
                {"replay.hindsight_goals", "-1", "0"}},
        Mistake{"EpisodesThatEndOnASuccessThatThereIsNot",
                {"shoal", "train", "--preset", "hopper-state", "--dry-run", "--set",
                 "end_on_success=true"},
                2,
                {"end_on_success", "has no goals"}},
        Mistake{"ThreadsThatCannotShareTheBatch",
                {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set",
                 "learner.batch=64", "--set", "replay.copies=2", "--set", "learner.threads=3"},
                2,
                {"learner.threads = 3", "64 / 2 = 32", "2 or 4"}},
        Mistake{"MoreEnvironmentsThanAWindowHolds",
                TrainWith("envs_per_actor=49"),
                2,
                {"envs_per_actor 49", "replay.window_chunks"}},
        Mistake{"AScheduleOfSamplesThatReachesZero",
                TrainWith("replay.samples_per_insert=linear(64,0,1000)"),
                2,
                {"replay.samples_per_insert = linear(64,0,1000)", "above 0"}},
        Mistake{"ABandInWhichBothWait", TrainWith("replay.band=0.001"), 2, {"replay.band 0.001"}},
        Mistake{"ARingWithoutRoomForSamples",
                {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set",
                 "replay.capacity=64", "--set", "replay.min_size=32", "--set", "replay.n_step=20"},
                2,
                {"replay.capacity = 64", "replay.n_step = 20"}},
        Mistake{"UnknownTask", TrainWith("task=FetchFly"), 2, {"FetchFly", "FetchReachDense"}},
        Mistake{"UnknownCamera",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "observation.cameras=[\"moon\"]"},
                2,
                {"moon", "front"}},
        Mistake{"TaskWithoutThePresetsCameras",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "task=walker_walk"},
                2,
                {"'front'", "observation.cameras", "side, back"}},
        Mistake{"EncoderThatDoesNotExist",
                TrainWith("network.encoder=resnet"),
                2,
                {"network.encoder", "resnet", "compact | drq | mrq | nature"}},
        Mistake{"EncoderThatDoesNotFitTheImages",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "network.encoder=nature", "--set", "observation.height=32"},
                2,
                {"network.encoder = nature", "32x84", "36x36"}},
        Mistake{"EncoderOfTorchvisionThatDoesNotFitTheImages",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "network.encoder=alexnet", "--set", "observation.width=60"},
                2,
                {"network.encoder = alexnet", "84x60", "63x63"}},
        Mistake{"EncoderWeightsThatAreNotThere",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "network.encoder_weights=/absent/encoder.safetensors"},
                2,
                {"network.encoder_weights", "/absent/encoder.safetensors"}},
        Mistake{"EncoderWeightsWithoutAnEncoder",
                TrainWith("network.encoder_weights=/absent/encoder.safetensors"),
                2,
                {"network.encoder_weights", "without pixels"}},
        Mistake{"KeyOfAnotherEncoder",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "network.encoder=drq", "--set", "network.pool=2"},
                2,
                {"network.pool", "compact", "drq"}},
        Mistake{"LayersTooLargeToBeCounted",
                {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set",
                 "network.hidden=[65536]", "--set", "learner.batch=65536"},
                2,
                {"network.hidden", "learner.batch = 65536", "2147483647"}},
        Mistake{"UnknownPreset",
                {"shoal", "train", "--preset", "nope", "--dry-run"},
                2,
                {"nope", "fetch-reach-drq"}},
        Mistake{"AbsentModel", TrainWith("model=/absent/robot.xml"), 2, {"/absent/robot.xml"}},
        Mistake{"AbsentConfigFile",
                {"shoal", "train", "--config", "/absent.json", "--dry-run"},
                1,
                {"/absent.json"}},
        Mistake{"UnknownOption", {"shoal", "train", "--fast"}, 2, {"--fast"}},
        Mistake{"UnknownCommand", {"shoal", "trian"}, 2, {"trian", "nearest is 'train'"}},
        Mistake{"HelpOfAnUnknownCommand", {"shoal", "env", "rendr", "--help"}, 2, {"'render'"}},
        Mistake{"PictureOfAnotherKind",
                {"shoal", "env", "render", "FetchReach", "--png", "x.jpg"},
                2,
                {"'x.jpg'", ".png"}},
        Mistake{"AbsentCheckpoint",
                {"shoal", "eval", "--checkpoint", "/absent/checkpoints/best", "--episodes", "1"},
                2,
                {"/absent"}},
        Mistake{"CheckpointOutsideARun",
                {"shoal", "eval", "--checkpoint", "/usr/share", "--episodes", "1"},
                2,
                {"'/usr/share' is neither a run nor RUN/checkpoints/NAME"}},
        Mistake{"AbsentReference", {"shoal", "env", "replay", "/absent.json"}, 1, {"/absent.json"}},
        Mistake{"UnknownRenderTask",
                {"shoal", "env", "render", "FetchFly", "--png", "/absent/x.png"},
                2,
                {"FetchFly"}},
        Mistake{"UnknownDescribeTask",
                {"shoal", "env", "describe", "FetchFly"},
                2,
                {"FetchFly", "FetchReachDense"}},
        Mistake{"MisspeltTask",
                {"shoal", "env", "describe", "FetchReechDense"},
                2,
                {"nearest is 'FetchReachDense'"}},
        Mistake{"MisspeltPreset",
                {"shoal", "train", "--preset", "fetch-reach-stat"},
                2,
                {"nearest is 'fetch-reach-state'"}},
        Mistake{"DescribeIntoNowhere",
                {"shoal", "env", "describe", "FetchReach", "--json", "/absent/x.json"},
                1,
                {"/absent/x.json"}},
        Mistake{"DescribeNothing",
                {"shoal", "env", "describe"},
                2,
                {"env describe", "--run RUN", "--preset NAME"}},
        Mistake{"DescribeTwoThings",
                {"shoal", "env", "describe", "FetchReach", "--preset", "fetch-reach-her"},
                2,
                {"--preset", "task"}},
        Mistake{"DescribeAnAbsentRun",
                {"shoal", "env", "describe", "--run", "nope"},
                2,
                {"nope", "config.json"}},
        Mistake{"DescribeAMisspeltPreset",
                {"shoal", "env", "describe", "--preset", "fetch-push-pixel"},
                2,
                {"nearest is 'fetch-push-pixels'"}},
        Mistake{"DescribeAModelOfARun",
                {"shoal", "env", "describe", "--run", "nope", "--model", "x.xml"},
                2,
                {"--model", "task"}},
        Mistake{"DescribeWithoutProbe",
                {"shoal", "env", "describe", "FetchReach", "--probe-steps", "0"},
                2,
                {"--probe-steps"}},
        Mistake{"UnknownRandomTask",
                {"shoal", "env", "random", "FetchFly"},
                2,
                {"FetchFly", "FetchReachDense"}},
        Mistake{"RandomWithoutEpisodes",
                {"shoal", "env", "random", "FetchReach", "--episodes", "0"},
                2,
                {"--episodes"}},
        Mistake{"RandomIntoNowhere",
                {"shoal", "env", "random", "FetchReach", "--json", "/absent/x.json"},
                1,
                {"/absent/x.json"}},
        Mistake{"RandomIntoAFolder",
                {"shoal", "env", "random", "FetchReach", "--json", "/"},
                1,
                {"'/'"}},
        Mistake{"UnknownRewardTask",
                {"shoal", "env", "reward-check", "FetchFly"},
                2,
                {"FetchFly", "FetchReachDense"}},
        Mistake{"RewardCheckWithoutSteps",
                {"shoal", "env", "reward-check", "FetchReach", "--steps", "0"},
                2,
                {"--steps"}},
        Mistake{"RewardCheckIntoNowhere",
                {"shoal", "env", "reward-check", "FetchReach", "--json", "/absent/x.json"},
                1,
                {"/absent/x.json"}},
        Mistake{"ListIntoNowhere",
                {"shoal", "env", "list", "--json", "/absent/x.json"},
                1,
                {"/absent/x.json"}},
        Mistake{"RenderOfNothing", {"shoal", "env", "render", "--png", "x.png"}, 2, {"task"}},
        Mistake{"ContactSheetOfOneTask",
                {"shoal", "env", "render", "FetchReach", "--contact-sheet", "--png", "x.png"},
                2,
                {"--contact-sheet"}},
        Mistake{"ContactSheetIntoNowhere",
                {"shoal", "env", "render", "--contact-sheet", "--png", "/absent/x.png"},
                1,
                {"/absent/x.png"}},
        Mistake{"CheckIntoNowhere",
                {"shoal", "check", "--json", "/absent/x.json"},
                1,
                {"/absent/x.json"}},
        Mistake{"ReplayWithoutRun", {"shoal-replay", "--run", "/absent"}, 1, {"/absent"}},
        Mistake{"LearnerWithoutRun", {"shoal-learner", "--run", "/absent"}, 1, {"/absent"}},
        Mistake{"ActorWithoutRun", {"shoal-actor", "--run", "/absent"}, 1, {"/absent"}},
        Mistake{"TopOfAbsentRun", {"shoal", "top", "--run", "nope"}, 2, {"nope", "config.json"}},
        Mistake{"TopOfNothing", {"shoal", "top", "--run-dir", "/absent"}, 1, {"/absent", "--peer"}},
        Mistake{"TopOfAMalformedPeer", {"shoal", "top", "--peer", "box:80"}, 2, {"box:80"}},
        Mistake{"TopOfASilentPeer",
                {"shoal", "top", "--peer", "127.0.0.1:32160"},
                1,
                {"127.0.0.1:32160", "did not answer"}},
        Mistake{"NoInterface", TrainWith("transport.interface=\"eth77\""), 1, {"eth77"}}),
    [](const auto& test) { return test.param.name; });

TEST(BadLimits, FewerOpenFilesThanARunNeedsAreNamed) {
  std::vector<std::string> command = TrainWith("seed=1");
  command[0] = ProgramPath("shoal");
  command.insert(command.begin(), {"/usr/bin/prlimit", "--nofile=12"});
  const ProgramResult result = RunCommand(command, std::chrono::seconds(30));
  EXPECT_EQ(ExitCode(result), 1) << result.err;
  EXPECT_NE(result.err.find("12 files (ulimit -n)"), std::string::npos) << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
}

// As folders are that were made before the evaluation actor had a key of its own.
TEST(BadCredentials, AMissingKeyOfAnyProcessIsNamedBeforeOneIsStarted) {
  const TrainingRun run;
  const std::string secure = (run.parent() / "secure").string();
  const auto deadline = std::chrono::seconds(30);
  ASSERT_EQ(ExitCode(RunProgram({"shoal", "secure", "init", secure}, deadline)), 0);
  std::filesystem::remove(secure + "/eval.key");
  const ProgramResult result = run.Train({}, {"--secure", secure}, deadline);
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  EXPECT_NE(result.err.find("eval.key"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(run.path()));
}

}  // namespace
}  // namespace shoal

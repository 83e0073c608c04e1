// SPDX-License-Identifier: Apache-2.0
// Every wrong thing a user can say gets one clear line that names it, and the right exit code.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/config/config_io.h"
#include "common/config/run_config.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "common/policy/policy_description.h"
#include "tests/support/temporary_folder.h"
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
        Mistake{"MoreThreadsThanTransitions",
                {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set",
                 "learner.batch=64", "--set", "replay.copies=2", "--set", "learner.threads=33"},
                2,
                {"learner.threads = 33", "64 / 2 = 32"}},
        Mistake{"MoreThreadsThanCores",
                {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set",
                 "learner.batch=1024", "--set", "learner.threads=1024"},
                2,
                {"learner.threads = 1024", "core", "--set learner.threads="}},
        Mistake{"MoreThreadsOfTheReplayThanCores",
                {"shoal", "train", "--preset", "fetch-reach-state", "--dry-run", "--set",
                 "replay.threads=1024"},
                2,
                {"replay.threads = 1024", "core", "--set replay.threads="}},
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
        Mistake{"ACameraOfAnotherTask",
                {"shoal", "train", "--preset", "fetch-reach-drq", "--dry-run", "--set",
                 "task=walker_walk", "--set", "observation.cameras=[\"front\"]"},
                2,
                {"'front'", "observation.cameras", "side, back"}},
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
        Mistake{"UnknownOption", {"shoal", "train", "--fast"}, 2, {"unknown option '--fast'"}},
        Mistake{"OptionOfAnotherProgram",
                {"shoal", "train", "--gpu", "1"},
                2,
                {"unknown option '--gpu'", "CPU"}},
        Mistake{"KeyAsAnOptionThatItDoesNotTake",
                {"shoal", "train", "--preset", "fetch-reach-state", "--seed", "x"},
                2,
                {"seed", "expected an integer"}},
        Mistake{"PresetWithoutItsOption",
                {"shoal", "train", "fetch-reach-state"},
                2,
                {"'fetch-reach-state'", "--preset fetch-reach-state"}},
        Mistake{"KeyOfAnotherProgram", TrainWith("batch_size=512"), 2, {"'learner.batch'"}},
        Mistake{
            "RunNameTooLong",
            {"shoal", "train", "--preset", "fetch-reach-state", "--name", std::string(300, 'a')},
            2,
            {"run_name", "too long with 300 characters", "at most 200"}},
        Mistake{"CommandOfAnotherProgram", {"shoal", "enjoy"}, 2, {"shoal film RUN"}},
        Mistake{"PlotOfNothing", {"shoal", "plot"}, 2, {"usage: shoal plot [OPTIONS] subjects..."}},
        Mistake{"SetOfNothing", {"shoal", "set"}, 2, {"shoal set [RUN] KEY=VALUE..."}},
        Mistake{"ScaleToNothing", {"shoal", "scale"}, 2, {"shoal scale [RUN] N"}},
        Mistake{"ScaleOfTwoRuns", {"shoal", "scale", "a", "b", "2"}, 2, {"'b'", "run 'a'"}},
        Mistake{"EvalOfNothing", {"shoal", "eval"}, 2, {"expected a run", "--checkpoint"}},
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

// Faults for which a run is refused at its start.
struct Refused {
  std::string name, preset;
  std::vector<std::string> assignments, mentions;
};

void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

class BadRun : public testing::TestWithParam<Refused> {};

TEST_P(BadRun, IsRefusedInOneLineBeforeAnythingStarts) {
  const TemporaryFolder folder;
  const std::filesystem::path runs = folder.path() / "runs";
  std::vector<std::string> command{"shoal",           "train", "--preset",
                                   GetParam().preset, "--set", "run_dir=" + runs.string()};
  for (const std::string& assignment : GetParam().assignments) {
    command.insert(command.end(), {"--set", assignment});
  }
  const ProgramResult result = RunProgram(command, std::chrono::seconds(30));
  EXPECT_EQ(ExitCode(result), 2) << result.out << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
  for (const std::string& word : GetParam().mentions) {
    EXPECT_NE(result.err.find(word), std::string::npos) << "no '" << word << "' in " << result.err;
  }
  EXPECT_EQ(result.out, "") << "the first lines of a run";
  EXPECT_FALSE(std::filesystem::exists(runs));
}

INSTANTIATE_TEST_SUITE_P(
    All, BadRun,
    testing::Values(
        Refused{"HindsightWithActionRepeat",
                "fetch-push-her",
                {"action_repeat=2"},
                {"replay.hindsight = future with action_repeat = 2", "expected action_repeat = 1"}},
        Refused{"HindsightWithoutGoals",
                "hopper-state",
                {"replay.hindsight=future"},
                {"replay.hindsight = future", "Hopper-v5 has no goals", "expected none"}},
        Refused{"HindsightOfGoalsThatThePolicyIsNotTold",
                "fetch-push-her",
                {"observation.goal_mode=none"},
                {"observation.goal_mode = none", "expected desired, both or image"}},
        Refused{"ARingSmallerThanAnEpisode",
                "fetch-push-her",
                {"envs_per_actor=1", "actors=1", "replay.capacity=64", "replay.min_size=10"},
                {"replay.capacity = 64", "episodes of 50 steps expected at least"}},
        Refused{"AnAlgorithmThatDoesNotExist",
                "fetch-reach-state",
                {"learner.algorithm=a2c"},
                {"learner.algorithm", "a2c", "sac | td3 | ddpg | ppo"}},
        Refused{"AnEncoderThatDoesNotExist",
                "fetch-reach-drq",
                {"network.encoder=resnet"},
                {"network.encoder", "resnet", "compact | drq | mrq | nature"}},
        Refused{"AnEncoderThatDoesNotFitTheImages",
                "fetch-reach-drq",
                {"network.encoder=nature", "observation.height=32"},
                {"network.encoder = nature", "32x84", "expected at least 36x36"}},
        Refused{"AKeyOfAnotherEncoder",
                "fetch-reach-drq",
                {"network.encoder=drq", "network.pool=2"},
                {"network.pool", "network.encoder = compact", "beside drq"}},
        Refused{"AKeyOfAnotherEncoderWithoutPixels",
                "fetch-reach-state",
                {"network.encoder=drq", "network.pool=2"},
                {"network.pool", "network.encoder = compact", "beside drq"}},
        Refused{"AnExplorationThatDoesNotExist",
                "fetch-reach-state",
                {"exploration.kind=brownian"},
                {"exploration.kind", "brownian", "auto | squashed_gaussian | gaussian | ou"}},
        Refused{"NoiseOfAnotherExploration",
                "fetch-reach-state",
                {"exploration.sigma=0.3"},
                {"exploration.sigma", "squashed_gaussian", "exploration.kind = gaussian | ou"}},
        Refused{"ABlockThatTheCriticCannotSee",
                "fetch-push-pixels",
                {"sac.critic_blocks=[\"objekt\"]"},
                {"sac.critic_blocks", "'objekt'", "expected some of: grip (3), object (3)"}},
        Refused{"ACriticThatWouldSeeNothing",
                "fetch-push-pixels",
                {"sac.critic_blocks=[\"grip\"]"},
                {"sac.critic_blocks", "observes all of grip", "expected some of", "object (3)"}},
        Refused{"ABlockThatCannotBeTaught",
                "fetch-push-pixels",
                {"sac.aux=[\"object-gripp\"]"},
                {"sac.aux", "'gripp'", "expected some of: grip (3), object (3)"}}),
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

// Weights of a policy with other layers, as `network.encoder_weights` and --init-from are given
// them.
TEST(BadWeights, OfAnotherNetworkAreRefusedNamingBoth) {
  const TemporaryFolder folder;
  const TrainingRun run;
  RunConfig wrote{LoadPreset("fetch-reach-drq"), {}};
  wrote.spec.task = "FetchReachDense";
  wrote.spec.cameras = {"front", "side"};
  wrote.spec.channels = 6;
  wrote.spec.height = wrote.spec.width = 84;
  wrote.spec.action_size = 4;
  WriteFileAtomically(folder.path() / kDescriptionFile,
                      policy::WriteDescription(
                          policy::Describe(wrote.config, wrote.spec, nn::ActorOutput::kGaussian)));
  nn::ParameterSet set(nn::PolicyParameters(wrote.config.network, wrote.spec),
                       nn::ParameterSet::Use::kInference);
  set.Initialise(1);
  nn::TensorMap tensors;
  set.Export(set.values(), "", &tensors);
  const std::string file = folder.path() / kPolicyFile;
  WriteFileAtomically(file, nn::WriteSafetensors(tensors, {}));
  const auto refusal = [&](const std::string& encoder, const std::vector<std::string>& flags) {
    const ProgramResult result = run.Train(
        TrainingRun::FromPixels({{"network.encoder", encoder}, {"observation.height", "84"}}),
        flags);
    EXPECT_EQ(ExitCode(result), 2) << result.out << result.err;
    EXPECT_EQ(std::ranges::count(result.err, '\n'), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(run.path()));
    return result.err;
  };
  const std::vector<std::string> preset{"--preset", "fetch-reach-drq"};
  for (const std::vector<std::string>& weights : std::vector<std::vector<std::string>>{
           {"--set", "network.encoder_weights=" + file}, {"--init-from", file}}) {
    std::vector<std::string> flags = preset;
    flags.insert(flags.end(), weights.begin(), weights.end());
    const std::string line = refusal("drq", flags);
    EXPECT_NE(line.find(": tensor "), std::string::npos) << line;
    EXPECT_NE(line.find("network.encoder = \"compact\" there, \"drq\" here"), std::string::npos)
        << line;
  }
}

// The run's own configuration, altered between its two parts.
TEST(BadWeights, ARunDoesNotGoOnWithACheckpointOfAnotherNetwork) {
  const TrainingRun run;
  const ProgramResult first = run.Train({{"env_steps", "1500"}, {"eval.final_episodes", "0"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  nlohmann::ordered_json config =
      nlohmann::ordered_json::parse(ReadFile(run.path() / "config.json"));
  config["network"]["hidden"] = {64};
  WriteFileAtomically(run.path() / "config.json", config.dump());
  const std::string log = ReadFile(run.path() / "logs" / "learner-0.log");
  const ProgramResult second =
      RunProgram({"shoal", "train", "--resume", run.path().string(), "--set", "env_steps=2500"},
                 std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(second), 2) << second.out << second.err;
  EXPECT_EQ(std::ranges::count(second.err, '\n'), 1) << second.err;
  EXPECT_NE(second.err.find("is of another network than the run's: network.hidden = [256,256] "
                            "there, [64] here"),
            std::string::npos)
      << second.err;
  EXPECT_EQ(second.out, "");
  EXPECT_EQ(ReadFile(run.path() / "logs" / "learner-0.log"), log) << "a learner was started";
}

// Folders made before the evaluation actor had a key of its own lack one.
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

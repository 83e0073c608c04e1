// SPDX-License-Identifier: Apache-2.0
// Runs that are refused at their start: one line names the reason, and no process is started.
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
                {"learner.algorithm", "a2c", "sac | td3 | ddpg | drqv2 | mrq | ppo"}},
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

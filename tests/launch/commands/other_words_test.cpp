// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/other_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <map>
#include <memory>

#include "common/base/command_line.h"
#include "launch/commands/command_line.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

class OtherWords : public testing::Test {
 protected:
  Words Taken(const Words& words) const { return AsCommandsTakeThem(*app_, words); }
  // The error message for a refused command line.
  std::string Refusal(const Words& words) const {
    return UsageMessage([&] { ParseCommandLine(app_.get(), Taken(words), HintForWord); });
  }

  Action chosen_;
  const std::unique_ptr<CLI::App> app_ = MakeCommandLine(&chosen_);
};

TEST_F(OtherWords, KeysAreOptionsOfTrainUnderTheirOwnNamesAndThoseOfOthers) {
  EXPECT_THAT(
      Taken({"train", "--seed", "3", "--preset", "p", "--learner.batch=64"}),
      ElementsAre("train", "--set", "seed=3", "--preset", "p", "--set", "learner.batch=64"));
  for (const auto& [option, key] :
       std::map<std::string, std::string>{{"--name", "run_name"},
                                          {"--task", "task"},
                                          {"--steps", "env_steps"},
                                          {"--total-timesteps", "env_steps"},
                                          {"--algo", "learner.algorithm"},
                                          {"--threads", "learner.threads"},
                                          {"--lr", "learner.learning_rate"},
                                          {"--batch-size", "learner.batch"},
                                          {"--gamma", "learner.discount"},
                                          {"--tau", "learner.tau"}}) {
    EXPECT_THAT(Taken({"train", option, "x"}), ElementsAre("train", "--set", key + "=x"));
    EXPECT_THAT(Taken({"train", option + "=-1"}), ElementsAre("train", "--set", key + "=-1"));
  }
}

TEST_F(OtherWords, AnEnvironmentThatIsNoTaskIsOneInPython) {
  for (const char* option : {"--env", "--task"}) {
    EXPECT_THAT(Taken({"train", option, "FetchPush"}),
                ElementsAre("train", "--set", "task=FetchPush"));
  }
  EXPECT_THAT(Taken({"train", "--env", "Pendulum-v1"}),
              ElementsAre("train", "--set", "env.id=Pendulum-v1"));
}

TEST_F(OtherWords, OptionsOfTrainItselfAndTheirValuesStay) {
  for (const Words& words :
       {Words{"train", "--set", "seed=3", "--film"}, Words{"train", "--run-name", "--seed"},
        Words{"train", "--resume=x"}, Words{"eval", "--seed", "3"}, Words{"top", "--steps", "3"}}) {
    EXPECT_EQ(Taken(words), words);
  }
}

TEST_F(OtherWords, AKeyWithoutAValueIsRefused) {
  for (const Words& words : {Words{"train", "--seed"}, Words{"train", "--seed", "--film"}}) {
    EXPECT_EQ(UsageMessage([&] { Taken(words); }), "train: --seed: expected a value");
  }
}

TEST_F(OtherWords, ADashBehindAFlagForJsonIsStandardOutputWhichItIsAnyway) {
  EXPECT_THAT(Taken({"runs", "--json", "-"}), ElementsAre("runs", "--json"));
  EXPECT_THAT(Taken({"experiment", "summary", "--json", "-", "e"}),
              ElementsAre("experiment", "summary", "--json", "e"));
  EXPECT_THAT(Taken({"eval", "r", "--json", "-"}), ElementsAre("eval", "r", "--json", "-"));
}

TEST_F(OtherWords, AnOptionThatNoKeyHasTheMeaningOfIsNamed) {
  EXPECT_EQ(Refusal({"train", "--gpu"}),
            "train: unknown option '--gpu'; a GPU is chosen by learner.device=cuda "
            "(see shoal train --help)");
  EXPECT_THAT(Refusal({"train", "--num-envs", "8"}),
              HasSubstr("'--num-envs'; nearest in meaning is --set envs_per_actor=VALUE, which"));
  EXPECT_THAT(Refusal({"train", "--presset", "p"}), HasSubstr("; nearest is '--preset'"));
  EXPECT_THAT(Refusal({"eval", "x", "--episode", "3"}), HasSubstr("; nearest is '--episodes'"));
}

TEST_F(OtherWords, AWordThatTrainDoesNotTakeIsNamedWithWhatItIs) {
  EXPECT_THAT(Refusal({"train", "fetch-reach-state"}),
              HasSubstr("'fetch-reach-state'; it is a preset: --preset fetch-reach-state"));
  EXPECT_THAT(Refusal({"train", "FetchPush"}), HasSubstr("; it is a task: --task FetchPush"));
  EXPECT_THAT(Refusal({"train", "mine.json"}), HasSubstr("--config mine.json"));
  EXPECT_THAT(Refusal({"train", "seed=3"}), HasSubstr("--set seed=3"));
  EXPECT_THAT(Refusal({"train", "fetch-reach-stat"}), HasSubstr("nearest is 'fetch-reach-state'"));
}

TEST_F(OtherWords, CommandsOfOtherProgramsAreAnsweredWithOurs) {
  const Words names{"runs", "film", "train"};
  EXPECT_THAT(HintForCommand("logs", names), HasSubstr("RUN/logs"));
  EXPECT_THAT(HintForCommand("list", names), HasSubstr("shoal runs"));
  EXPECT_THAT(HintForCommand("enjoy", names), HasSubstr("shoal film RUN"));
  EXPECT_THAT(HintForCommand("tensorboard", names), HasSubstr("tensorboard --logdir runs"));
  EXPECT_EQ(HintForCommand("trian", names), "; nearest is 'train'");
  EXPECT_EQ(HintForCommand("quux", names), "");
}

TEST_F(OtherWords, WhatIsMissingIsSaidWithTheUsage) {
  EXPECT_EQ(Refusal({"plot"}),
            "plot: subjects is required; usage: shoal plot [OPTIONS] subjects...");
  EXPECT_THAT(Refusal({"replay", "peek"}), HasSubstr("usage: shoal replay peek [OPTIONS] "));
}

}  // namespace
}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/run/start_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class StartTextTest : public testing::Test {
 protected:
  StartTextTest() {
    Config& config = request_.config.config;
    config.observation.pixels = false;
    config.seed = 3;
    config.env_steps = 9000;
    config.actors = 2;
    config.envs_per_actor = 4;
    config.learner.threads = 1;
    request_.config.spec.blocks = {{"position", 3, true}};
    request_.config.spec.action_size = 2;
  }
  std::string Text() const {
    return StartText(request_, run_.path(), {.domain = 4, .tag = "t", .host = "10.0.0.1"});
  }

  TemporaryFolder run_;
  RunRequest request_;
};

TEST_F(StartTextTest, CountsTheProcesses) {
  EXPECT_THAT(Text(), AllOf(HasSubstr("run " + run_.path().string() + ": "),
                            HasSubstr("\n  seed 3, 9000 env steps; 1 replay, 1 learner ("),
                            HasSubstr("), 2 actor(s) of 4 environments, 1 evaluation actor; logs "
                                      "in " +
                                      (run_.path() / "logs").string() + "\n"),
                            HasSubstr("shoal top --run " + run_.path().string() +
                                      ", or --peer 10.0.0.1:8660\n"),
                            Not(HasSubstr("goes on at"))));
}

TEST_F(StartTextTest, ARunOnPolicyHasNoReplay) {
  request_.config.config.learner.algorithm = "ppo";
  EXPECT_THAT(Text(), AllOf(HasSubstr("9000 env steps; 1 learner ("), HasSubstr("no replay")));
}

TEST_F(StartTextTest, AResumedRunSaysWhereItGoesOn) {
  request_.meta.env_steps = 600;
  EXPECT_THAT(Text(), HasSubstr("\n  goes on at 600 env steps, without a checkpoint\n"));
}

TEST_F(StartTextTest, NamesTheHostsOfActorsAndTheCameras) {
  request_.hosts.hosts.resize(1);
  request_.hosts.hosts[0].name = "far";
  request_.hosts.hosts[0].actors = 1;
  request_.hosts.hosts[0].run = "/there/a";
  request_.camera_note = "  the policy sees through front\n";
  EXPECT_THAT(Text(), AllOf(HasSubstr("\n  1 of the actors on far, in /there/a\n"),
                            HasSubstr("\n  the policy sees through front\n")));
}

TEST_F(StartTextTest, ActorsOnOtherHostsDoNotShareTheCoresOfThisOne) {
  request_.config.config.actors = 100;
  EXPECT_THAT(Text(), HasSubstr("100 actors share"));
  request_.hosts.hosts.resize(1);
  request_.hosts.hosts[0].actors = 99;
  EXPECT_THAT(Text(), Not(HasSubstr("actors share")));
}

}  // namespace
}  // namespace shoal::launch

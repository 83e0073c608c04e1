// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/scalar_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/event_files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

MetricsMessage LearnerReport(double updates, double env_steps, double critic_loss) {
  MetricsMessage report;
  report.role = "learner";
  report.names = {"updates",     "env_steps",        "critic_loss", "actor_loss",
                  "temperature", "temperature_loss", "reward_mean"};
  report.values = {updates, env_steps, critic_loss, -1, 0.25, 2, -0.75};
  return report;
}

class ScalarLogTest : public ::testing::Test {
 protected:
  Scalars Read() {
    log_.Flush();
    const auto files = EventFiles(folder_.path() / "tensorboard");
    EXPECT_EQ(files.size(), 1u);
    return ReadScalars(files.at(0));
  }

  TemporaryFolder folder_;
  ScalarLog log_{folder_.path()};
  const SteadyTime start_ = Now();
};

TEST_F(ScalarLogTest, OneFileHasTheTagsThatPeopleKnow) {
  log_.WriteTraining(LearnerReport(10, 1000, 0.5), start_);
  log_.WriteTraining(LearnerReport(30, 1500, 0.75), start_ + seconds(2));
  log_.WriteEvaluation({.env_steps = 1400, .success = 0.5, .mean_return = -3, .mean_length = 50});
  MetricsView view;
  MetricsMessage actor;
  actor.role = "actor";
  actor.names = {"episodes", "rollout_return", "rollout_length"};
  actor.values = {4, -2, 50};
  view.OnMessage(actor, start_);
  ProgressFigures figures;
  figures.env_steps = 1450;
  figures.rollout_success = 0.25;
  log_.WriteRollouts(view, figures, start_);
  const Scalars scalars = Read();
  EXPECT_THAT(scalars.at("train/critic_loss"), ElementsAre(Pair(1000, 0.5f), Pair(1500, 0.75f)));
  EXPECT_THAT(scalars.at("train/actor_loss"), ElementsAre(Pair(1000, -1), Pair(1500, -1)));
  EXPECT_EQ(scalars.count("train/temperature"), 0u) << "no curve twice";
  EXPECT_THAT(scalars.at("train/ent_coef"), ElementsAre(Pair(1000, 0.25f), Pair(1500, 0.25f)));
  EXPECT_THAT(scalars.at("train/ent_coef_loss"), ElementsAre(Pair(1000, 2), Pair(1500, 2)));
  EXPECT_THAT(scalars.at("replay/reward_mean"), ElementsAre(Pair(1000, -0.75), Pair(1500, -0.75)));
  EXPECT_EQ(scalars.count("train/reward_mean"), 0u);
  EXPECT_THAT(scalars.at("train/n_updates"), ElementsAre(Pair(1000, 10), Pair(1500, 30)));
  EXPECT_THAT(scalars.at("time/fps"), ElementsAre(Pair(1500, 250)));
  EXPECT_THAT(scalars.at("eval/mean_reward"), ElementsAre(Pair(1400, -3)));
  EXPECT_THAT(scalars.at("eval/mean_ep_length"), ElementsAre(Pair(1400, 50)));
  EXPECT_THAT(scalars.at("eval/success_rate"), ElementsAre(Pair(1400, 0.5f)));
  EXPECT_THAT(scalars.at("rollout/ep_rew_mean"), ElementsAre(Pair(1450, -2)));
  EXPECT_THAT(scalars.at("rollout/success_rate"), ElementsAre(Pair(1450, 0.25f)));
  EXPECT_THAT(scalars.at("rollout/ep_len_mean"), ElementsAre(Pair(1450, 50)));
}

TEST_F(ScalarLogTest, AReportWithoutNewUpdatesAddsNoPoint) {
  log_.WriteTraining(LearnerReport(10, 1000, 0.5), start_);
  log_.WriteTraining(LearnerReport(10, 1010, 0.5), start_ + seconds(1));
  EXPECT_THAT(Read().at("train/critic_loss"), ElementsAre(Pair(1000, 0.5f)));
}

// The learner of a resumed run reports at the env steps where its predecessor stopped.
TEST_F(ScalarLogTest, AResumedRunAddsNoStepTwice) {
  log_.WriteTraining(LearnerReport(10, 1000, 0.5), start_);
  log_.WriteTraining(LearnerReport(20, 1500, 0.5), start_);
  log_.WriteEvaluation({.env_steps = 1400, .success = {}, .mean_return = -3});
  log_.Flush();
  ScalarLog resumed(folder_.path());
  resumed.WriteTraining(LearnerReport(15, 1400, 0.75), start_);
  resumed.WriteTraining(LearnerReport(20, 1500, 0.75), start_);
  resumed.WriteTraining(LearnerReport(30, 1600, 0.75), start_);
  resumed.WriteEvaluation({.env_steps = 1400, .success = {}, .mean_return = -3});
  resumed.WriteEvaluation({.env_steps = 1600, .success = {}, .mean_return = -2});
  resumed.Flush();
  const auto files = EventFiles(folder_.path() / "tensorboard");
  ASSERT_EQ(files.size(), 2u);
  const Scalars scalars = ReadScalars(files[1]);
  EXPECT_THAT(scalars.at("train/critic_loss"), ElementsAre(Pair(1600, 0.75f)));
  EXPECT_THAT(scalars.at("eval/mean_reward"), ElementsAre(Pair(1600, -2)));
}

TEST_F(ScalarLogTest, AReportBeforeTheFirstUpdateAndThoseOfOthersAddNone) {
  MetricsMessage starting = LearnerReport(500, 1000, 0);
  starting.names.resize(2);
  starting.values.resize(2);
  log_.WriteTraining(starting, start_);
  MetricsMessage other = LearnerReport(500, 1000, 0);
  other.role = "actor";
  log_.WriteTraining(other, start_);
  EXPECT_THAT(Read(), IsEmpty());
}

TEST_F(ScalarLogTest, TheConfigurationIsATextAndASessionOfHyperParameters) {
  Config config;
  config.learner.batch = 77;
  config.task = "FetchPush";
  log_.WriteConfig(config);
  log_.WriteEnd(false);
  log_.Flush();
  const auto values = ReadPluginValues(EventFiles(folder_.path() / "tensorboard").at(0));
  const auto& text = values.at("configuration");
  EXPECT_EQ(text.metadata().plugin_data().plugin_name(), "text");
  EXPECT_THAT(text.tensor().string_val(0), HasSubstr("| learner.batch | 77 |\n"));
  EXPECT_THAT(text.tensor().string_val(0), HasSubstr("| task | FetchPush |\n"));

  tensorboard::proto::HParamsPluginData start, end;
  const auto content = [&](const std::string& tag) {
    EXPECT_EQ(values.at(tag).metadata().plugin_data().plugin_name(), "hparams");
    return values.at(tag).metadata().plugin_data().content();
  };
  ASSERT_TRUE(start.ParseFromString(content("_hparams_/session_start_info")));
  const auto& settings = start.session_start_info().hparams();
  EXPECT_EQ(settings.at("learner.batch").number_value(), 77);
  EXPECT_EQ(settings.at("task").string_value(), "FetchPush");
  EXPECT_EQ(settings.at("observation.pixels").bool_value(), config.observation.pixels);
  EXPECT_EQ(settings.at("network.hidden").string_value(), "[256,256]");
  ASSERT_TRUE(end.ParseFromString(content("_hparams_/session_end_info")));
  EXPECT_EQ(end.session_end_info().status(), 2) << "failure";
}

}  // namespace
}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// The worked example of docs/own_algorithm.md does what its page says.
#include <gmock/gmock.h>

#include "averaged_ddpg.h"
#include "common/base/error.h"
#include "common/config/config_io.h"
#include "common/config/exploration_kind.h"
#include "common/config/run_files.h"
#include "common/nn/policy.h"
#include "common/nn/precision.h"
#include "learner/device/device_agent.h"
#include "strided_encoder.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/learner/agent/bar_pictures.h"
#include "tests/support/temporary_folder.h"

namespace shoal::learner {
namespace {

using nn::Precision;

Config OwnConfig(Config config = SmallConfig()) {
  ApplyAssignments({"learner.algorithm=averaged_ddpg"}, &config);
  return config;
}

std::unique_ptr<Agent> SmallAgent() { return MakeAgent(OwnConfig(), SmallSpec(), Precision::kF32); }

UpdateOutcome UpdateWith(Agent* agent, uint64_t key) {
  return agent->Update(RandomBatch(SmallSpec(), SmallConfig().learner.batch, key).View());
}

TEST(OwnAlgorithm, ReportsItsFiguresInTheirOrder) {
  const UpdateOutcome outcome = UpdateWith(SmallAgent().get(), 1);
  ASSERT_TRUE(outcome.finite);
  std::vector<const Figure*> figures;
  for (const auto& entry : outcome.figures.entries()) figures.push_back(entry.figure);
  EXPECT_THAT(figures, ::testing::ElementsAreArray(kAveragedDdpgFigures));
  EXPECT_GT(Get(outcome, kCriticSpread), 0);
}

TEST(OwnAlgorithm, ItsLineSaysWhatItIs) {
  const Algorithm& line = FindAlgorithm("averaged_ddpg");
  const auto tensors = SmallAgent()->AllTensors();
  for (int i = 1; i <= line.critics; ++i) {
    EXPECT_TRUE(tensors.contains("critic.q" + std::to_string(i) + ".output.weight")) << i;
  }
  EXPECT_FALSE(tensors.contains("critic.q4.output.weight"));
  EXPECT_EQ(FindFigure("critic_spread"), &kCriticSpread);
}

// The learner's way: from the configuration in a run's folder.
TEST(OwnAlgorithm, ARunThatNamesItMakesIt) {
  const TemporaryFolder folder;
  RunConfig run{OwnConfig(), SmallSpec()};
  ApplyAssignments({"network.encoder=strided", "network.filters=[]", "network.strides=[]"},
                   &run.config);
  WriteRunConfig(folder.path(), run);
  const RunConfig read = ReadRunConfig(folder.path());
  EXPECT_EQ(ExplorationKindOf(read.config), ExplorationKind::kGaussian) << "it has no deviation";
  const auto tensors = MakeAgent(read.config, read.spec, Precision::kF32)->AllTensors();
  EXPECT_TRUE(tensors.contains("critic.q3.output.weight"));
  EXPECT_EQ(tensors.at("encoder.conv2.weight").shape, (std::vector<int64_t>{32, 32, 5, 5}));
}

// It has operations on the host.
TEST(OwnAlgorithm, ADeviceRefusesIt) {
  try {
    device::CheckComputes(OwnConfig());
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "learner.algorithm = averaged_ddpg: a device does not compute this algorithm, "
                 "expected sac | td3 | ddpg | drqv2 | ppo");
  }
}

TEST(OwnAlgorithm, GoesOnByteForByteFromWhatItLeft) {
  const auto agent = SmallAgent(), other = SmallAgent();
  for (uint64_t u = 0; u < 3; ++u) UpdateWith(agent.get(), u);
  other->Restore(agent->AllTensors(), "test");
  EXPECT_EQ(other->updates(), 3u);
  for (uint64_t u = 3; u < 6; ++u) {
    UpdateWith(agent.get(), u);
    UpdateWith(other.get(), u);
  }
  EXPECT_THAT(Differences(agent->AllTensors(), other->AllTensors()), ::testing::IsEmpty());
}

TEST(OwnAlgorithm, AnUpdateThatIsNotFiniteChangesNothing) {
  const auto agent = SmallAgent();
  UpdateWith(agent.get(), 1);
  const nn::TensorMap before = agent->AllTensors();
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 2);
  const BatchView view = batch.View();
  view.reward[1] = 1e25f;  // its squared error is not
  EXPECT_FALSE(agent->Update(view).finite);
  EXPECT_THAT(Differences(before, agent->AllTensors()), ::testing::IsEmpty());
}

// It has no line of code for them.
TEST(OwnAlgorithm, LearnsOnSeveralThreadsAsOnOne) {
  const auto one = SmallAgent();
  EXPECT_EQ(ReplicasOf(OwnConfig(), SmallSpec(), 2), 2);
  nn::SetThreads(2);
  const auto two = SmallAgent();
  nn::SetThreads(1);
  for (uint64_t u = 0; u < 3; ++u) {
    const UpdateOutcome expected = UpdateWith(one.get(), u), outcome = UpdateWith(two.get(), u);
    for (const auto& [figure, value] : expected.figures.entries()) {
      EXPECT_NEAR(Get(outcome, *figure), value, 1e-3 * std::abs(value)) << figure->name;
    }
  }
}

TEST(OwnAlgorithm, LearnsABandit) { EXPECT_LT(BanditError(OwnConfig(Config()), MakeAgent), 0.08); }

TEST(OwnEncoder, IsAPlanFromWhichShapesAndParametersFollow) {
  nn::NetworkPlan plan(nn::MapShape{.channels = 9, .height = 84, .width = 84});
  nn::AddStrided(NetworkConfig(), "encoder", &plan);
  EXPECT_EQ(plan.output(), (nn::MapShape{.channels = 32, .height = 11, .width = 11}));
  const auto parameters = plan.Parameters();
  ASSERT_EQ(parameters.size(), 6u);
  EXPECT_EQ(parameters[0].name, "encoder.conv0.weight");
  EXPECT_THAT(parameters[0].shape, ::testing::ElementsAre(32, 9, 5, 5));
  nn::NetworkPlan small(nn::MapShape{.channels = 3, .height = 1, .width = 1});
  nn::AddStrided(NetworkConfig(), "encoder", &small);
  EXPECT_EQ(small.output().height, 1) << "padding keeps what is small";
}

constexpr int kSide = 16;

ObservationSpec BarSpec() {
  ObservationSpec spec;
  spec.task = "bars";
  spec.cameras = {"front"};
  spec.channels = 1;
  spec.height = spec.width = kSide;
  spec.stack = 1;
  spec.action_size = 1;
  return spec;
}

// A bandit on pictures: reward -(a - place / 2)^2, every step terminal. The least loss of a critic
// that does not see the bar's place is 25 (E[a^2] / 3 + 1 / 180) = 2.9, that of three critics 8.7.
TEST(OwnEncoder, LearnsABanditOnPictures) {
  Config config = OwnConfig(Config());
  ApplyAssignments(
      {"network.encoder=strided", "network.hidden=[32]", "learner.batch=32",
       "learner.learning_rate=2e-3", "learner.actor_learning_rate=1e-4", "learner.reward_scale=5"},
      &config);
  const auto agent = MakeAgent(config, BarSpec(), Precision::kF32);
  const nn::TensorMap start = agent->PolicyTensors();
  constexpr uint64_t kUpdates = 300, kWindow = 20;
  double first = 0, last = 0;  // the loss, over a window
  Random random(1);
  for (uint64_t u = 0; u < kUpdates; ++u) {
    const RandomBatch batch(BarSpec(), config.learner.batch, u);
    const BatchView view = batch.View();
    for (size_t b = 0; b < view.reward.size(); ++b) {
      const auto picture = view.obs_frames.subspan(b * kSide * kSide, size_t{kSide} * kSide);
      const float place = DrawBar(int(random.Next() % (kSide - kBarWidth + 1)), kSide, picture);
      const float error = view.action[b] - place / 2;
      view.reward[b] = -error * error;
      view.bootstrap[b] = 0;
    }
    const UpdateOutcome outcome = agent->Update(view);
    ASSERT_TRUE(outcome.finite);
    if (u < kWindow) first += Get(outcome, kCriticLoss) / kWindow;
    if (u >= kUpdates - kWindow) last += Get(outcome, kCriticLoss) / kWindow;
  }
  EXPECT_GT(first, 8.7);
  EXPECT_LT(last, 4);
  // All of it is trained: weights and biases of three convolutions.
  EXPECT_EQ(Differences(start, agent->PolicyTensors(), "encoder.").size(), 6u);
}

}  // namespace
}  // namespace shoal::learner

// The worked example of docs/own_algorithm.md does what its page says.
#include <gmock/gmock.h>

#include "averaged_ddpg.h"
#include "common/base/error.h"
#include "common/nn/policy.h"
#include "strided_encoder.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::Precision;

std::unique_ptr<Agent> SmallAgent() {
  return MakeAveragedDdpgAgent(SmallConfig(), SmallSpec(), Precision::kF32);
}

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

// The line that the page adds to kAlgorithms.
TEST(OwnAlgorithm, ItsLineSaysWhatItIs) {
  constexpr Algorithm kLine = {.name = "averaged_ddpg",
                               .figures = kAveragedDdpgFigures,
                               .critics = 3,
                               .make = MakeAveragedDdpgAgent};
  const auto tensors = kLine.make(SmallConfig(), SmallSpec(), Precision::kF32)->AllTensors();
  for (int i = 1; i <= kLine.critics; ++i) {
    EXPECT_TRUE(tensors.contains("critic.q" + std::to_string(i) + ".output.weight")) << i;
  }
  EXPECT_FALSE(tensors.contains("critic.q4.output.weight"));
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

TEST(OwnAlgorithm, LearnsABandit) { EXPECT_LT(BanditError(Config(), MakeAveragedDdpgAgent), 0.08); }

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

}  // namespace
}  // namespace shoal::learner

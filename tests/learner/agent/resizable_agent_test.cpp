// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/resizable_agent.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/nn/parallel.h"
#include "learner/agent/algorithms.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using testing::IsEmpty;

class ResizableAgentTest : public testing::Test {
 protected:
  ~ResizableAgentTest() override { nn::SetThreads(1); }

  ResizableAgent Of(int threads) {
    return {[this](int number) {
              made_.push_back(number);
              if (number > 4) throw UsageError("{} threads", number);
              nn::SetThreads(number);
              return MakeAgent(config_, SmallSpec(), nn::Precision::kF32);
            },
            threads};
  }
  void Update(Agent* agent, uint64_t from, uint64_t to) {
    for (uint64_t u = from; u < to; ++u) {
      const RandomBatch batch(SmallSpec(), BatchOptions{.batch = config_.learner.batch}, u);
      ASSERT_TRUE(agent->Update(batch.View()).finite);
    }
  }

  Config config_ = SmallConfig();
  std::vector<int> made_;
};

TEST_F(ResizableAgentTest, NothingOfTheStateChangesWithTheNumber) {
  ResizableAgent agent = Of(1);
  Update(&agent, 0, 3);
  const nn::TensorMap before = agent.AllTensors();
  agent.Resize(3);
  EXPECT_EQ(agent.threads(), 3);
  EXPECT_EQ(agent.updates(), 3u);
  EXPECT_THAT(Differences(agent.AllTensors(), before), IsEmpty());
}

// The same as a learner that was started with the second number from the first one's checkpoint.
TEST_F(ResizableAgentTest, ItGoesOnAsIfFromACheckpoint) {
  ResizableAgent agent = Of(1);
  Update(&agent, 0, 3);
  ResizableAgent restored = Of(3);
  restored.Restore(agent.AllTensors(), "test");
  agent.Resize(3);
  Update(&agent, 3, 6);
  Update(&restored, 3, 6);
  EXPECT_THAT(Differences(agent.AllTensors(), restored.AllTensors()), IsEmpty());
}

TEST_F(ResizableAgentTest, TheSameNumberMakesNothingAnew) {
  ResizableAgent agent = Of(2);
  agent.Resize(2);
  EXPECT_THAT(made_, testing::ElementsAre(2));
}

TEST_F(ResizableAgentTest, ANumberThatDoesNotFitLeavesTheAgentAsItIs) {
  ResizableAgent agent = Of(2);
  Update(&agent, 0, 2);
  const nn::TensorMap before = agent.AllTensors();
  EXPECT_THROW(agent.Resize(5), Error);
  EXPECT_EQ(agent.threads(), 2);
  EXPECT_THAT(Differences(agent.AllTensors(), before), IsEmpty());
  Update(&agent, 2, 3);
  EXPECT_EQ(agent.updates(), 3u);
}

}  // namespace
}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
// Rows of one transition in a batch (Eq. 15): the rows that form its target, and their weights in
// the losses.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using testing::IsEmpty;
using testing::Not;

constexpr int kCopies = 2;

class CopiesTest : public testing::TestWithParam<const char*> {
 protected:
  Config ConfigOf(int target_shifts) const {
    Config config = SmallConfig();
    config.learner.algorithm = GetParam();
    config.learner.actor_period = 1;
    config.replay.copies = kCopies;
    config.replay.target_shifts = target_shifts;
    return config;
  }

  // Every tensor after one update.
  static nn::TensorMap Updated(const Config& config, const RandomBatch& batch) {
    const std::unique_ptr<Agent> agent = MakeAgent(config, SmallSpec(), nn::Precision::kF32);
    EXPECT_TRUE(agent->Update(batch.View()).finite);
    return agent->AllTensors();
  }
};

// Row `row` of the next frames of `view`, other than it was.
void DisturbNextFrames(const BatchView& view, size_t row) {
  const size_t bytes = view.next_obs_frames.size() / view.reward.size();
  for (uint8_t& pixel : view.next_obs_frames.subspan(row * bytes, bytes)) pixel = ~pixel;
}

TEST_P(CopiesTest, ATargetIsMadeOfAsManyRowsAsThereAreShiftsOfTheNextFrame) {
  for (const bool first : {true, false}) {
    const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 5),
        disturbed(SmallSpec(), SmallConfig().learner.batch, 5);
    std::ranges::fill(batch.View().bootstrap, 1.f);
    std::ranges::fill(disturbed.View().bootstrap, 1.f);
    DisturbNextFrames(disturbed.View(), first ? kCopies : kCopies + 1);
    const auto changed = [&](int shifts) {
      return Differences(Updated(ConfigOf(shifts), batch), Updated(ConfigOf(shifts), disturbed));
    };
    EXPECT_THAT(changed(0), Not(IsEmpty()));
    EXPECT_THAT(changed(2), Not(IsEmpty()));
    if (first) {
      EXPECT_THAT(changed(1), Not(IsEmpty()));
    } else {
      EXPECT_THAT(changed(1), IsEmpty()) << "the second row has no shift of its own";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CopiesTest, testing::Values("sac", "td3", "ddpg", "drqv2"));

// Every row of `from` twice, to `to`.
template <class T>
void RepeatRows(size_t rows, std::span<const T> from, std::span<T> to) {
  const size_t size = from.size() / rows;
  ASSERT_EQ(to.size(), kCopies * from.size());
  for (size_t i = 0; i < to.size(); ++i) to[i] = from[i / size / kCopies * size + i % size];
}

// One shift of each kind: a batch of pairs of equal rows must give the same update as the single
// rows. DDPG, because it draws no noise.
TEST(Copies, RowsThatAreAllAlikeWeighAsOne) {
  Config config = SmallConfig();
  config.learner.algorithm = "ddpg";
  config.learner.actor_period = 1;
  const int transitions = config.learner.batch;
  const RandomBatch once(SmallSpec(), transitions, 3), pairs(SmallSpec(), 2 * transitions, 4);
  const BatchView a = once.View(), b = pairs.View();
  const auto rows = size_t(transitions);
  RepeatRows<uint8_t>(rows, a.obs_frames, b.obs_frames);
  RepeatRows<uint8_t>(rows, a.next_obs_frames, b.next_obs_frames);
  for (const auto member : {&BatchView::obs_vector, &BatchView::next_obs_vector, &BatchView::action,
                            &BatchView::reward, &BatchView::bootstrap}) {
    RepeatRows<float>(rows, a.*member, b.*member);
  }
  const auto updated = [](const Config& of, const BatchView& view) {
    const std::unique_ptr<Agent> agent = MakeAgent(of, SmallSpec(), nn::Precision::kF32);
    EXPECT_TRUE(agent->Update(view).finite);
    return agent->AllTensors();
  };
  const nn::TensorMap alone = updated(config, a);
  config.learner.batch = kCopies * transitions;
  config.replay.copies = kCopies;
  config.replay.target_shifts = config.replay.critic_shifts = 1;
  const nn::TensorMap together = updated(config, b);
  int compared = 0;
  for (const auto& [name, tensor] : alone) {
    if (!name.starts_with("adam.m.")) continue;  // 0.1 of the gradient
    const std::vector<float> x = Floats(alone, name), y = Floats(together, name);
    for (size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(y[i], x[i], 1e-5f * (1 + std::abs(x[i]))) << name << ' ' << i;
      compared += x[i] != 0;
    }
  }
  EXPECT_GT(compared, 500);
}

}  // namespace
}  // namespace shoal::learner

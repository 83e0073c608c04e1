// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/mrq/model_loss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "common/base/random.h"

namespace shoal::learner {
namespace {

TEST(TwoHotTest, ItsMeanIsTheReward) {
  const std::vector<double>& bins = RewardBins();
  for (const double reward : {-21'000.0, -3.7, -0.001, 0.0, 0.1, 1.0, 5.5, 20'000.0}) {
    const TwoHot hot = TwoHotOf(reward);
    const double mean = (1 - hot.weight_of_next) * bins[size_t(hot.low)] +
                        hot.weight_of_next * bins[size_t(hot.low) + 1];
    EXPECT_NEAR(mean, reward, 1e-9 * std::max(1.0, std::abs(reward)));
    EXPECT_LE(bins[size_t(hot.low)], reward);
    EXPECT_GE(bins[size_t(hot.low) + 1], reward);
  }
}

TEST(TwoHotTest, ARewardBeyondTheBinsBelongsToTheLastOne) {
  EXPECT_EQ(TwoHotOf(-1e9).low, 0);
  EXPECT_EQ(TwoHotOf(1e9).low, nn::kRewardBins - 1);
  EXPECT_EQ(TwoHotOf(-1e9).weight_of_next, 0);
  EXPECT_EQ(TwoHotOf(1e9).weight_of_next, 0);
}

TEST(TwoHotTest, TheBinsAreSymmetricAndReachE10) {
  const std::vector<double>& bins = RewardBins();
  ASSERT_EQ(bins.size(), size_t(nn::kRewardBins));
  EXPECT_NEAR(bins.back(), std::exp(10.0) - 1, 1e-6);
  for (size_t i = 0; i < bins.size(); ++i) EXPECT_EQ(bins[i], -bins[bins.size() - 1 - i]);
}

class ModelLossTest : public testing::Test {
 protected:
  static constexpr size_t kRows = 3, kState = 4;

  ModelLossTest() {
    Random random(5);
    const auto fill = [&](std::vector<float>* values, size_t size) {
      values->resize(size);
      for (float& value : *values) value = float(random.Normal());
    };
    fill(&end_, kRows);
    fill(&state_, kRows * kState);
    fill(&logits_, kRows * nn::kRewardBins);
    fill(&target_, kRows * kState);
    fill(&reward_, kRows);
  }

  // The loss, averaged over the rows; `gradients`: dL/d(end, state, logits), one after another.
  double Loss(std::vector<float>* gradients = nullptr) const {
    std::vector<float> end(end_.size()), state(state_.size()), logits(logits_.size());
    std::vector<float> state_loss(kRows), reward_loss(kRows), end_loss(kRows);
    AddModelLoss({end_, state_, logits_, target_, reward_, terminated_, present_}, kWeights,
                 {end, state, logits}, {state_loss, reward_loss, end_loss});
    if (gradients != nullptr) {
      *gradients = end;
      gradients->insert(gradients->end(), state.begin(), state.end());
      gradients->insert(gradients->end(), logits.begin(), logits.end());
    }
    double sum = 0;
    for (size_t b = 0; b < kRows; ++b) {
      sum += state_loss[b] + kWeights.reward * reward_loss[b] + kWeights.end * end_loss[b];
    }
    return sum / double(kRows);
  }

  static constexpr ModelLossWeights kWeights{.reward = 0.3, .end = 0.7};
  std::vector<float> end_, state_, logits_, target_, reward_;
  std::vector<float> terminated_{0, 1, 0}, present_{1, 1, 0};
};

TEST_F(ModelLossTest, GradientsAgreeWithDifferences) {
  std::vector<float> gradients;
  Loss(&gradients);
  size_t i = 0;
  for (std::vector<float>* inputs : {&end_, &state_, &logits_}) {
    for (float& input : *inputs) {
      const float before = input;
      input = before + 0.01f;
      const double above = Loss();
      input = before - 0.01f;
      const double below = Loss();
      input = before;
      EXPECT_NEAR(gradients[i], (above - below) / 0.02, 2e-4) << i;
      ++i;
    }
  }
  EXPECT_EQ(i, gradients.size());
}

TEST_F(ModelLossTest, AStepThatIsNotPresentDoesNotCount) {
  const double loss = Loss();
  state_.back() += 5;
  end_.back() += 5;
  reward_.back() += 5;
  EXPECT_EQ(Loss(), loss);
  present_.back() = 1;
  EXPECT_GT(Loss(), loss);
}

TEST_F(ModelLossTest, TheLossOfThePredictedRewardIsLeastForTheTwoHotReward) {
  present_ = {1, 0, 0};
  state_ = target_;
  end_ = terminated_;
  const TwoHot hot = TwoHotOf(reward_[0]);
  for (size_t i = 0; i < nn::kRewardBins; ++i) logits_[i] = -30;
  logits_[size_t(hot.low)] = float(std::log(1 - hot.weight_of_next));
  logits_[size_t(hot.low) + 1] = float(std::log(hot.weight_of_next));
  std::vector<float> gradients;
  Loss(&gradients);
  for (const float gradient : gradients) EXPECT_NEAR(gradient, 0, 1e-6);
}

}  // namespace
}  // namespace shoal::learner

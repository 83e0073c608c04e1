// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/action_selector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "tests/actor/acting/normal_sample.h"
#include "tests/actor/policy_weights.h"

namespace shoal::actor {
namespace {

using testing::Each;
using testing::ElementsAreArray;
using testing::HasSubstr;

constexpr int kSelectorEnvs = 2, kActions = 3;
constexpr float kMean = 0.3F;

// In the first episode of each environment.
class Selector : public ActionSelector {
 public:
  Selector(const Config& config, const ObservationSpec& spec)
      : ActionSelector(config, spec, kSelectorEnvs) {
    for (int e = 0; e < kSelectorEnvs; ++e) BeginEpisode(e, static_cast<uint64_t>(100 + e));
  }
};

class ActionSelectorTest : public testing::Test {
 protected:
  ActionSelectorTest() {
    config_.learner.precision = "f32";
    config_.network.hidden = {4};
    spec_.blocks = {{"observation", 2}};
    spec_.action_size = kActions;
  }

  Selector Make() const { return Selector(config_, spec_); }
  ReceivedWeights Weights(uint64_t run_env_steps = 0) const {
    return ConstantPolicy(config_.network, spec_, {1, 20}, kMean, /*raw_log_std=*/0, run_env_steps);
  }
  static std::vector<float> Actions(const ActionSelector& selector) {
    std::vector<float> actions;
    for (int e = 0; e < kSelectorEnvs; ++e) {
      const auto action = selector.ActionOf(e);
      actions.insert(actions.end(), action.begin(), action.end());
    }
    return actions;
  }
  std::vector<double> Sample(ActionSelector& selector, Acting acting) const {
    std::vector<double> sample;
    for (int i = 0; i < 4000; ++i) {
      selector.Select(acting);
      for (const float action : Actions(selector)) sample.push_back(double{action});
    }
    return sample;
  }

  Config config_;
  ObservationSpec spec_;
};

// Uniform on [-1, 1]: mean 0, deviation 1 / sqrt(3), both with errors below the normal's.
void ExpectUniform(const std::vector<double>& sample) {
  EXPECT_TRUE(LooksNormal(sample, 0, 1 / std::sqrt(3.0)));
  EXPECT_LE(*std::ranges::max_element(sample), 1);
  EXPECT_GT(*std::ranges::max_element(sample), 0.99);
  EXPECT_GE(*std::ranges::min_element(sample), -1);
  EXPECT_LT(*std::ranges::min_element(sample), -0.99);
}

TEST_F(ActionSelectorTest, ActionsAreUniformBeforeAnyWeightsWhateverIsAskedFor) {
  for (const Acting acting : {Acting::kUniform, Acting::kExplore, Acting::kMean}) {
    Selector selector = Make();
    ExpectUniform(Sample(selector, acting));
  }
}

TEST_F(ActionSelectorTest, AWarmUpIsUniformThoughThereAreWeights) {
  Selector selector = Make();
  selector.Load(Weights());
  ExpectUniform(Sample(selector, Acting::kUniform));
}

TEST_F(ActionSelectorTest, ExploringIsThePolicysGaussianThroughTanh) {
  Selector selector = Make();
  selector.Load(Weights());
  std::vector<double> sample = Sample(selector, Acting::kExplore);
  for (double& a : sample) a = std::atanh(a);
  const double sigma = std::exp(-1.5);  // Eq. 4 of a raw number of 0
  EXPECT_TRUE(LooksNormal(sample, kMean, sigma));
  EXPECT_FALSE(LooksNormal(Scaled(sample, kMean, 0), kMean, sigma));
}

TEST_F(ActionSelectorTest, TheMeanIsPlayedWithoutADraw) {
  Selector selector = Make();
  selector.Load(Weights());
  const ActionSelector::Noise before = selector.NoiseOf(0);
  selector.Select(Acting::kMean);
  EXPECT_THAT(Actions(selector), Each(testing::FloatEq(std::tanh(kMean))));
  EXPECT_EQ(selector.NoiseOf(0), before);
}

TEST_F(ActionSelectorTest, AnEpisodesNoiseFollowsFromItsKeyAlone) {
  Selector selector = Make();
  selector.Load(Weights());
  selector.Select(Acting::kExplore);
  const std::vector<float> first = Actions(selector);
  EXPECT_NE(first[0], first[kActions]) << "environments have noise of their own";
  EXPECT_NE(first[0], first[1]);
  selector.Select(Acting::kExplore);
  EXPECT_NE(Actions(selector), first);
  selector.BeginEpisode(0, 100);
  selector.BeginEpisode(1, 101);
  selector.Select(Acting::kExplore);
  EXPECT_THAT(Actions(selector), ElementsAreArray(first));
}

TEST_F(ActionSelectorTest, GoesOnFromAnothersNoise) {
  config_.exploration.kind = "ou";
  Selector selector = Make(), successor = Make();
  selector.Load(Weights());
  successor.Load(Weights());
  for (int i = 0; i < 3; ++i) selector.Select(Acting::kExplore);
  for (int e = 0; e < kSelectorEnvs; ++e) successor.SetNoise(e, selector.NoiseOf(e));
  selector.Select(Acting::kExplore);
  successor.Select(Acting::kExplore);
  EXPECT_THAT(Actions(successor), ElementsAreArray(Actions(selector)));
}

TEST_F(ActionSelectorTest, ANewEpisodesNoiseHasNoMemoryOfTheOld) {
  config_.exploration.kind = "ou";
  Selector selector = Make(), fresh = Make();
  selector.Load(Weights());
  fresh.Load(Weights());
  for (int i = 0; i < 3; ++i) selector.Select(Acting::kExplore);
  selector.BeginEpisode(0, 100);
  selector.BeginEpisode(1, 101);
  selector.Select(Acting::kExplore);
  fresh.Select(Acting::kExplore);
  EXPECT_THAT(Actions(selector), ElementsAreArray(Actions(fresh)));
}

TEST_F(ActionSelectorTest, WeightsSayHowFarTheScheduleIs) {
  config_.exploration.kind = "gaussian";
  config_.exploration.sigma = {0.5, 0, 1000};
  Selector selector = Make();
  selector.Load(Weights(/*run_env_steps=*/999));
  EXPECT_EQ(selector.run_env_steps(), 999u);
  selector.Select(Acting::kExplore);
  EXPECT_NE(selector.ActionOf(0)[0], std::tanh(kMean));
  ReceivedWeights later = Weights(/*run_env_steps=*/1000);
  later.version.update = 40;
  selector.Load(later);
  selector.Select(Acting::kExplore);
  EXPECT_FLOAT_EQ(selector.ActionOf(0)[0], std::tanh(kMean)) << "no noise is left";
}

TEST_F(ActionSelectorTest, WeightsThatDoNotFitAreRefusedAndTheFormerStay) {
  Selector selector = Make();
  selector.Load(Weights());
  NetworkConfig wider = config_.network;
  wider.hidden = {5};
  try {
    selector.Load(ConstantPolicy(wider, spec_, {1, 40}, 0, 0));
    FAIL() << "took another network's weights";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("weights of update 40"));
  }
  EXPECT_EQ(selector.version().update, 20u);
  selector.Select(Acting::kMean);
  EXPECT_THAT(Actions(selector), Each(testing::FloatEq(std::tanh(kMean))));
}

}  // namespace
}  // namespace shoal::actor

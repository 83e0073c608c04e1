// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/exploration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "tests/actor/acting/normal_sample.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

constexpr int kSample = 20'000;
constexpr float kPolicyMean = 0.1F, kLogStd = -1.5F;

Config ConfigOf(const std::string& kind, Schedule sigma = Schedule::Constant(0.2)) {
  Config config;
  config.exploration.kind = kind;
  config.exploration.sigma = sigma;
  return config;
}

// A policy with a constant distribution of its single action component.
class Player {
 public:
  explicit Player(const Config& config, double factor = 1)
      : exploration_(MakeExploration(config, /*envs=*/1, /*action_size=*/1, factor)) {}

  Exploration& exploration() { return *exploration_; }
  float Act() {
    float action = 0;
    exploration_->Act(0, {std::span(&kPolicyMean, 1), std::span(&kLogStd, 1)}, stream_,
                      {&action, 1});
    return action;
  }
  void Begin() { exploration_->BeginEpisode(0); }

  // The noise on the action of the mean.
  double Noise() { return double{Act()} - double{std::tanh(kPolicyMean)}; }
  std::vector<double> Noises() {
    std::vector<double> noises(kSample);
    for (double& noise : noises) noise = Noise();
    return noises;
  }
  // The arguments of tanh.
  std::vector<double> Unsquashed() {
    std::vector<double> numbers(kSample);
    for (double& number : numbers) number = std::atanh(double{Act()});
    return numbers;
  }
  Random& stream() { return stream_; }

 private:
  std::unique_ptr<Exploration> exploration_;
  Random stream_{17};
};

TEST(PolicyDraw, IsClippedForTheEnvironmentAndRememberedAsDrawn) {
  Config config;
  config.learner.algorithm = "ppo";
  const auto exploration = MakeExploration(config, /*envs=*/1, /*action_size=*/2, 1);
  const float mean[] = {0.9F, -0.3F}, log_std[] = {0.5F, -1.F};
  Random stream(17), same(17);
  int clipped = 0;
  for (int i = 0; i < 200; ++i) {
    float action[2], drawn[2];
    exploration->Act(0, {.mean = mean, .log_std = log_std, .squashed = false}, stream, action);
    const float log_prob = exploration->Drawn(drawn);
    double expected = 0;
    for (int a = 0; a < 2; ++a) {
      const double noise = same.Normal(), sigma = std::exp(double{log_std[a]});
      EXPECT_NEAR(drawn[a], mean[a] + sigma * noise, 1e-5);
      EXPECT_EQ(action[a], std::clamp(drawn[a], -1.F, 1.F));
      // The density of N(mean, sigma^2) where it was drawn.
      const double pi = std::acos(-1.0), z = (double{drawn[a]} - mean[a]) / sigma;
      expected += std::log(std::exp(-z * z / 2) / (sigma * std::sqrt(2 * pi)));
      clipped += action[a] != drawn[a];
    }
    EXPECT_NEAR(log_prob, expected, 1e-4);
  }
  EXPECT_GT(clipped, 20) << "the case is too easy";
}

TEST(SquashedGaussian, IsEquationFourBitForBit) {
  Player player(ConfigOf("squashed_gaussian"));
  Random same(17);
  for (int i = 0; i < 1000; ++i) {
    const float expected =
        std::tanh(kPolicyMean + std::exp(kLogStd) * static_cast<float>(same.Normal()));
    ASSERT_EQ(player.Act(), expected) << i;
  }
  EXPECT_EQ(player.stream().state(), same.state()) << "one draw a component";
}

TEST(SquashedGaussian, HasThePolicysMeanAndDeviation) {
  const std::vector<double> sample = Player(ConfigOf("squashed_gaussian")).Unsquashed();
  const double sigma = std::exp(kLogStd);
  EXPECT_TRUE(LooksNormal(sample, kPolicyMean, sigma));
  // The same test rejects wrong samples.
  EXPECT_FALSE(LooksNormal(Scaled(sample, kPolicyMean, 0), kPolicyMean, sigma));
  EXPECT_FALSE(LooksNormal(Scaled(sample, kPolicyMean, 1.1), kPolicyMean, sigma));
  EXPECT_FALSE(LooksNormal(sample, kPolicyMean + 0.02, sigma));
}

TEST(ExplorationKind, AutoIsWhatTheAlgorithmWants) {
  EXPECT_EQ(Player(ConfigOf("auto")).Act(), Player(ConfigOf("squashed_gaussian")).Act());
  EXPECT_NE(Player(ConfigOf("auto")).Act(), Player(ConfigOf("gaussian")).Act());
  Config deterministic = ConfigOf("auto");
  deterministic.learner.algorithm = "td3";
  EXPECT_EQ(Player(deterministic).Act(), Player(ConfigOf("gaussian")).Act());
}

TEST(GaussianNoise, IsAddedToTheActionOfTheMean) {
  const std::vector<double> noises = Player(ConfigOf("gaussian")).Noises();
  EXPECT_TRUE(LooksNormal(noises, 0, 0.2));
  EXPECT_FALSE(LooksNormal(Scaled(noises, 0, 0), 0, 0.2));
  EXPECT_FALSE(LooksNormal(Scaled(noises, 0, 1.1), 0, 0.2));
}

TEST(GaussianNoise, ActionsAreClippedToTheirBounds) {
  Player player(ConfigOf("gaussian", Schedule::Constant(3)));
  std::vector<float> actions(100);
  for (float& action : actions) action = player.Act();
  EXPECT_THAT(actions, Each(AllOf(Ge(-1), Le(1))));
  EXPECT_THAT(actions, Contains(-1));
  EXPECT_THAT(actions, Contains(1));
}

TEST(GaussianNoise, FollowsItsScheduleOverTheRunsEnvSteps) {
  Player player(ConfigOf("gaussian", {0.2, 0.1, 1000}));
  EXPECT_TRUE(LooksNormal(player.Noises(), 0, 0.2)) << "before anything is known of the run";
  player.exploration().OnEnvSteps(500);
  EXPECT_TRUE(LooksNormal(player.Noises(), 0, 0.15));
  player.exploration().OnEnvSteps(2000);
  EXPECT_TRUE(LooksNormal(player.Noises(), 0, 0.1));
}

TEST(GaussianNoise, FollowsTheScheduleOfAnAlgorithmThatHasItsOwn) {
  for (const char* kind : {"auto", "ou"}) {
    Config config = ConfigOf(kind, Schedule::Constant(0.9));
    config.learner.algorithm = "drqv2";
    config.drqv2.noise = {0.2, 0.1, 1000};
    config.exploration.dt = 1;
    Player own(config);
    config.learner.algorithm = "td3";
    config.exploration.sigma = config.drqv2.noise;
    Player same(config);
    for (const uint64_t run_env_steps : {0u, 500u, 2000u}) {
      own.exploration().OnEnvSteps(run_env_steps);
      same.exploration().OnEnvSteps(run_env_steps);
      for (int i = 0; i < 10; ++i) ASSERT_EQ(own.Act(), same.Act()) << kind << run_env_steps;
    }
  }
}

// The deviation is so small that an action of the policy is within 0.01 of its mean.
TEST(RandomShareOf, IsTheShareOfUniformActions) {
  for (const double share : {0.2, 1.0}) {
    Config config = ConfigOf("gaussian", Schedule::Constant(1e-3));
    config.exploration.random_share = share;
    Player player(config);
    int random = 0;
    double sum = 0, squares = 0;
    for (int i = 0; i < kSample; ++i) {
      const double action = player.Act();
      if (std::fabs(action - std::tanh(kPolicyMean)) < 0.01) continue;
      ++random;
      sum += action;
      squares += action * action;
    }
    // A uniform action is so close to the mean with probability 0.01.
    EXPECT_NEAR(random / double{kSample}, 0.99 * share, 0.01);
    EXPECT_NEAR(sum / random, 0, 0.03);
    EXPECT_NEAR(squares / random, 1.0 / 3, 0.01);
  }
}

TEST(RandomShareOf, LeavesTheOtherStepsToTheNoise) {
  Config config = ConfigOf("ou");
  Player whole(config);
  config.exploration.random_share = 1;
  Player none(config);
  for (int i = 0; i < 5; ++i) whole.Act();
  const std::vector<double> carried = whole.exploration().StateOf(0);
  ASSERT_NE(carried, std::vector<double>(1));
  none.exploration().SetState(0, carried);
  for (int i = 0; i < 5; ++i) none.Act();
  EXPECT_EQ(none.exploration().StateOf(0), carried);
  none.Begin();
  EXPECT_THAT(none.exploration().StateOf(0), ElementsAre(0));
}

TEST(NoiseFactorOf, MultipliesTheNoiseOfEveryKind) {
  EXPECT_TRUE(LooksNormal(Player(ConfigOf("gaussian"), 0.5).Noises(), 0, 0.1));
  EXPECT_TRUE(LooksNormal(Player(ConfigOf("squashed_gaussian"), 0.5).Unsquashed(), kPolicyMean,
                          0.5 * std::exp(kLogStd)));
  Player whole(ConfigOf("ou")), half(ConfigOf("ou"), 0.5);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR(half.Noise(), 0.5 * whole.Noise(), 1e-6);
  EXPECT_GT(std::fabs(whole.Noise()), 1e-4);
}

TEST(NoiseFactorOf, LiesGeometricallyEvenAroundOne) {
  Config config;
  config.actors = 3;
  EXPECT_EQ(NoiseFactor(config, 2), 1) << "all alike unless spread";
  config.exploration.spread = 4;
  EXPECT_DOUBLE_EQ(NoiseFactor(config, 0), 0.25);
  EXPECT_DOUBLE_EQ(NoiseFactor(config, 1), 1);
  EXPECT_DOUBLE_EQ(NoiseFactor(config, 2), 4);
  EXPECT_DOUBLE_EQ(NoiseFactor(config, 3), 0.25) << "an actor that joined takes turns";
  config.actors = 1;
  EXPECT_EQ(NoiseFactor(config, 0), 1);
}

// At dt = 1 and theta = 0.15 the noise forgets within steps: rho = 0.85.
class OrnsteinUhlenbeckTest : public testing::Test {
 protected:
  static constexpr double kSigma = 0.05, kRho = 0.85;
  static Config Quick() {
    Config config = ConfigOf("ou", Schedule::Constant(kSigma));
    config.exploration.dt = 1;
    return config;
  }
  // Deviation of x_t: sigma^2 (1 - rho^2t) / (1 - rho^2).
  static double Deviation(int t) {
    return kSigma * std::sqrt((1 - std::pow(kRho, 2 * t)) / (1 - kRho * kRho));
  }
  // x_t of many episodes, for t = `first` and the next step.
  static std::array<std::vector<double>, 2> Play(const Config& config, int first) {
    Player player(config);
    std::array<std::vector<double>, 2> noises;
    for (int episode = 0; episode < kSample; ++episode) {
      player.Begin();
      for (int t = 1; t < first; ++t) player.Noise();
      noises[0].push_back(player.Noise());
      noises[1].push_back(player.Noise());
    }
    return noises;
  }
  static bool LooksCorrelated(const std::array<std::vector<double>, 2>& noises, double expected) {
    double product = 0;
    for (size_t i = 0; i < noises[0].size(); ++i) product += noises[0][i] * noises[1][i] / kSample;
    const double seen = product / MomentsOf(noises[0]).deviation / MomentsOf(noises[1]).deviation;
    return std::fabs(seen - expected) < 5 * (1 - expected * expected) / std::sqrt(kSample);
  }
};

TEST_F(OrnsteinUhlenbeckTest, GrowsFromZeroAtEachReset) {
  const auto noises = Play(Quick(), 1);
  EXPECT_TRUE(LooksNormal(noises[0], 0, Deviation(1))) << "whatever the episode before left";
  EXPECT_TRUE(LooksNormal(noises[1], 0, Deviation(2)));
  EXPECT_FALSE(LooksNormal(noises[1], 0, Deviation(1)));
  EXPECT_FALSE(LooksNormal(Scaled(noises[0], 0, 0), 0, Deviation(1)));
}

TEST_F(OrnsteinUhlenbeckTest, RemembersItself) {
  const auto noises = Play(Quick(), 5);
  EXPECT_TRUE(LooksNormal(noises[1], 0, Deviation(6)));
  const double correlation = kRho * Deviation(5) / Deviation(6);
  EXPECT_TRUE(LooksCorrelated(noises, correlation));
  Config memoryless = Quick();
  memoryless.exploration.kind = "gaussian";
  EXPECT_FALSE(LooksCorrelated(Play(memoryless, 5), correlation));
  Config forgetful = Quick();
  forgetful.exploration.theta = 0.3;
  EXPECT_FALSE(LooksCorrelated(Play(forgetful, 5), correlation));
}

TEST_F(OrnsteinUhlenbeckTest, ItsStepsScaleWithTheRootOfTime) {
  Config config = Quick();
  config.exploration.dt = 0.01;
  EXPECT_TRUE(LooksNormal(Play(config, 1)[0], 0, 0.1 * kSigma));
}

TEST_F(OrnsteinUhlenbeckTest, GoesOnFromItsState) {
  Player player(Quick()), successor(Quick());
  for (int i = 0; i < 5; ++i) player.Act();
  const std::vector<double> state = player.exploration().StateOf(0);
  ASSERT_EQ(state.size(), 1u);
  successor.exploration().SetState(0, state);
  successor.stream().set_state(player.stream().state());
  EXPECT_EQ(successor.Act(), player.Act());
  player.Begin();
  EXPECT_THAT(player.exploration().StateOf(0), ElementsAre(0));
}

TEST_F(OrnsteinUhlenbeckTest, AStateOfAnotherKindIsRefused) {
  Player ou(Quick()), gaussian(ConfigOf("gaussian"));
  EXPECT_THAT(gaussian.exploration().StateOf(0), testing::IsEmpty());
  EXPECT_THROW(gaussian.exploration().SetState(0, std::vector<double>{0.5}), Error);
  try {
    ou.exploration().SetState(0, {});
    FAIL() << "went on without its noise";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("0 numbers"), HasSubstr("expected 1")));
  }
}

TEST(RandomSteps, AreSharedByTheActors) {
  Config config;
  config.actors = 3;
  EXPECT_EQ(RandomStepsOfActor(config), 0u);
  config.exploration.random_steps = 1000;
  EXPECT_EQ(RandomStepsOfActor(config), 334u);
  config.actors = 1;
  EXPECT_EQ(RandomStepsOfActor(config), 1000u);
}

}  // namespace
}  // namespace shoal::actor

// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sac/sac_agent.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "common/nn/policy.h"
#include "tests/learner/agent/sac_agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::Precision;
using nn::TensorMap;
using testing::IsEmpty;
using testing::Not;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(SacAgent, EncoderAndCriticGetNoGradientFromTheActor) {
  Config with = SmallConfig(), without = SmallConfig();
  with.learner.actor_period = 1;
  without.learner.actor_period = 1'000;
  const auto a = SmallAgent(with), b = SmallAgent(without);
  UpdateTimes(a.get(), 1);
  b->Restore(a->AllTensors(), "a");
  UpdateTimes(a.get(), 1, 200);
  UpdateTimes(b.get(), 1, 200);
  const TensorMap after_a = a->AllTensors(), after_b = b->AllTensors();
  for (const char* prefix :
       {"encoder.", "critic.", "target.", "adam.m.encoder.", "adam.m.critic."}) {
    EXPECT_THAT(Differences(after_a, after_b, prefix), IsEmpty());
  }
  for (const char* prefix : {"actor.", "temperature.", "adam.m.actor."}) {
    EXPECT_THAT(Differences(after_a, after_b, prefix), Not(IsEmpty()));
  }
}

TEST(SacAgent, AnActorsOwnEncoderIsTrainedByItsLossAlone) {
  Config with = WithEncoders("separate", true), without = with;
  with.learner.actor_period = 1;
  without.learner.actor_period = 1'000;
  const auto a = SmallAgent(with), b = SmallAgent(without);
  UpdateTimes(a.get(), 1);
  b->Restore(a->AllTensors(), "a");
  const TensorMap before = a->AllTensors();
  UpdateTimes(a.get(), 1, 200);
  UpdateTimes(b.get(), 1, 200);
  const TensorMap after_a = a->AllTensors(), after_b = b->AllTensors();
  EXPECT_THAT(Differences(after_a, after_b, "critic."), IsEmpty());
  EXPECT_THAT(Differences(after_a, after_b, "target."), IsEmpty());
  EXPECT_THAT(Differences(before, after_b, "critic.encoder."), Not(IsEmpty()));
  EXPECT_THAT(Differences(before, after_b, "encoder."), IsEmpty());
  EXPECT_THAT(Differences(before, after_a, "encoder."), Not(IsEmpty()));
}

// The encoder of `of` is `source`'s.
void ExpectEncoder(const TensorMap& tensors, const std::string& of, const std::string& source,
                   bool equal) {
  int compared = 0;
  for (const auto& [name, tensor] : tensors) {
    if (!name.starts_with(of)) continue;
    const auto a = Floats(tensors, name), b = Floats(tensors, source + name.substr(of.size()));
    float apart = 0;
    for (size_t i = 0; i < a.size(); ++i) apart = std::max(apart, std::abs(a[i] - b[i]));
    EXPECT_EQ(apart < 1e-6f, equal) << name << ' ' << apart;
    ++compared;
  }
  EXPECT_EQ(compared, 4);
}

TEST(SacAgent, ATargetEncoderStartsAtTheCriticsAndFollowsIt) {
  for (const auto& [encoders, critics] :
       {std::pair("shared", "encoder."), std::pair("separate", "critic.encoder.")}) {
    Config config = WithEncoders(encoders, true);
    config.learner.tau = 1;
    config.learner.target_period = 2;
    const auto agent = SmallAgent(config);
    ExpectEncoder(agent->AllTensors(), "target.encoder.", critics, true);
    UpdateTimes(agent.get(), 2);  // after the first one it moved, after the second it did not
    ExpectEncoder(agent->AllTensors(), "target.encoder.", critics, false);
    UpdateTimes(agent.get(), 1, 300);
    ExpectEncoder(agent->AllTensors(), "target.encoder.", critics, true);
  }
}

TEST(SacAgent, TheTargetSeesItsOwnEncoder) {
  const Config config = WithEncoders("shared", true);
  const auto agent = SmallAgent(config), disturbed = SmallAgent(config);
  disturbed->Restore(Perturbed(agent->AllTensors(), "target.encoder."), "test");
  const RandomBatch batch(SmallSpec(), config.learner.batch, 1);
  const UpdateOutcome a = agent->Update(batch.View()), b = disturbed->Update(batch.View());
  EXPECT_NE(Get(a, kTargetMean), Get(b, kTargetMean));
  EXPECT_EQ(Get(a, kQMean), Get(b, kQMean));
}

TEST(SacAgent, ActorAndTemperatureMoveEveryPeriodAndHaveNoFiguresBetween) {
  Config config = SmallConfig();
  config.learner.actor_period = 3;
  const auto agent = SmallAgent(config);
  for (int u = 0; u < 7; ++u) {
    const TensorMap before = agent->AllTensors();
    const RandomBatch batch(SmallSpec(), config.learner.batch, uint64_t(u));
    const UpdateOutcome stats = agent->Update(batch.View());
    const TensorMap after = agent->AllTensors();
    EXPECT_THAT(Differences(before, after, "critic."), Not(IsEmpty()));
    const bool moved = !Differences(before, after, "actor.").empty();
    EXPECT_EQ(moved, u % 3 == 0) << u;
    EXPECT_EQ(!Differences(before, after, "temperature.").empty(), moved) << u;
    for (const Figure* figure : {&kActorLoss, &kTemperatureLoss, &kEntropy, &kActorGradNorm}) {
      EXPECT_EQ(stats.figures.Get(*figure).has_value(), moved) << u << ' ' << figure->name;
    }
  }
}

TEST(SacAgent, CopiesOfATransitionShareTheMeanOfTheirTargets) {
  Config config = SmallConfig();
  const RandomBatch batch(SmallSpec(), config.learner.batch, 1);
  const UpdateOutcome alone = SmallAgent(config)->Update(batch.View());
  config.replay.copies = 2;
  const UpdateOutcome copies = SmallAgent(config)->Update(batch.View());
  EXPECT_NEAR(Get(copies, kTargetMean), Get(alone, kTargetMean), 1e-6);
  EXPECT_EQ(Get(copies, kQMean), Get(alone, kQMean));
  EXPECT_NE(Get(copies, kCriticLoss), Get(alone, kCriticLoss));
}

TEST(SacAgent, TargetsStartAtTheCriticAndMoveByTauEveryPeriod) {
  Config config = SmallConfig();
  config.learner.tau = 0.25;
  config.learner.target_period = 2;
  const auto agent = SmallAgent(config);
  const TensorMap start = agent->AllTensors();
  for (int u = 0; u < 3; ++u) {
    const TensorMap before = agent->AllTensors();
    UpdateTimes(agent.get(), 1, uint64_t(u));
    const TensorMap after = agent->AllTensors();
    int compared = 0;
    for (const auto& [name, tensor] : after) {
      if (!name.starts_with("target.")) continue;
      const std::string online = "critic." + name.substr(std::string("target.").size());
      EXPECT_EQ(start.at(name).data, start.at(online).data) << name;
      const auto x = Floats(before, name), y = Floats(after, online), moved = Floats(after, name);
      for (size_t i = 0; i < x.size(); ++i, ++compared) {
        const float expected = u % 2 == 0 ? x[i] + 0.25f * (y[i] - x[i]) : x[i];
        ASSERT_NEAR(moved[i], expected, 1e-7) << name << " " << u;
      }
    }
    EXPECT_GT(compared, 100);
  }
}

TEST(SacAgent, RunsRepeatByteForByteWithTheSameNumberOfThreads) {
  for (const Precision precision : Precisions()) {
    for (const int threads : {1, 2}) {
      nn::SetThreads(threads);
      const auto a = SmallAgent(SmallConfig(), precision), b = SmallAgent(SmallConfig(), precision);
      UpdateTimes(a.get(), 5);
      UpdateTimes(b.get(), 5);
      EXPECT_THAT(Differences(a->AllTensors(), b->AllTensors()), IsEmpty()) << threads;
    }
  }
  nn::SetThreads(1);
}

TEST(SacAgent, SeedsGiveDifferentNetworks) {
  Config other = SmallConfig();
  other.seed = 8;
  EXPECT_THAT(Differences(SmallAgent(SmallConfig())->AllTensors(), SmallAgent(other)->AllTensors(),
                          "encoder."),
              Not(IsEmpty()));
}

TEST(SacAgent, NonFiniteInputIsReportedAndChangesNothing) {
  const auto agent = SmallAgent(SmallConfig());
  UpdateTimes(agent.get(), 3);
  const TensorMap before = agent->AllTensors();
  const auto expect_refused = [&](auto member, float value) {
    const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 9);
    BatchView view = batch.View();
    (view.*member)[1] = value;
    EXPECT_FALSE(agent->Update(view).finite);
    EXPECT_THAT(Differences(before, agent->AllTensors()), IsEmpty());
  };
  expect_refused(&BatchView::obs_vector, kNan);
  expect_refused(&BatchView::next_obs_vector, INFINITY);
  expect_refused(&BatchView::action, kNan);
  expect_refused(&BatchView::reward, -INFINITY);
  expect_refused(&BatchView::bootstrap, kNan);
  expect_refused(&BatchView::reward, 1e25f);  // finite, but its squared error is not
  UpdateTimes(agent.get(), 1);                // and it goes on
  EXPECT_EQ(agent->updates(), 4u);
}

// A learning rate with which the critic's step is finite but its next output is not. The actor's
// loss is then not finite, and the critic's step must be undone.
TEST(SacAgent, NonFiniteActorLossTakesTheCriticsStepBack) {
  Config config = SmallConfig();
  config.learner.learning_rate = 1e37;
  const auto agent = SmallAgent(config);
  const TensorMap before = agent->AllTensors();
  const RandomBatch batch(SmallSpec(), config.learner.batch, 1);
  const UpdateOutcome stats = agent->Update(batch.View());
  EXPECT_TRUE(std::isfinite(Get(stats, kCriticLoss)));
  EXPECT_FALSE(stats.finite);
  EXPECT_THAT(Differences(before, agent->AllTensors()), IsEmpty());
  // The layers have the old weights back as well: the critic's loss is what it was.
  EXPECT_EQ(Get(agent->Update(batch.View()), kCriticLoss), Get(stats, kCriticLoss));
}

TEST(SacAgent, PolicyTensorsAreTheAgentsOwnAndLoadIntoAPolicy) {
  for (const Config& config : {SmallConfig(), WithEncoders("separate", true)}) {
    const auto agent = SmallAgent(config);
    UpdateTimes(agent.get(), 2);
    const TensorMap policy = agent->PolicyTensors(), all = agent->AllTensors();
    for (const auto& [name, tensor] : policy) {
      EXPECT_TRUE(name.starts_with("encoder.") || name.starts_with("actor.")) << name;
      EXPECT_EQ(tensor.data, all.at(name).data) << name;
    }
    nn::Policy loaded(config.network, SmallSpec(), Precision::kF32, 4);
    EXPECT_NO_THROW(loaded.Load(policy, "agent"));
  }
}

TEST(SacAgent, TheAveragedPolicyFollowsByTheRate) {
  Config config = SmallConfig();
  config.learner.average_rate = 0.25;
  const auto agent = SmallAgent(config);
  TensorMap average = agent->AveragedPolicyTensors();
  EXPECT_THAT(Differences(average, agent->PolicyTensors()), IsEmpty()) << "it starts as the policy";
  UpdateTimes(agent.get(), 3);
  average = agent->AveragedPolicyTensors();
  UpdateTimes(agent.get(), 1);
  const TensorMap policy = agent->PolicyTensors(), moved = agent->AveragedPolicyTensors();
  ASSERT_EQ(moved.size(), policy.size());
  bool differs = false;
  for (const auto& [name, tensor] : moved) {
    const auto number = [&name = name](const TensorMap& tensors, size_t i) {
      float value = 0;
      std::memcpy(&value, tensors.at(name).data.data() + 4 * i, 4);
      return value;
    };
    for (size_t i = 0; i < tensor.data.size() / 4; ++i) {
      const float before = number(average, i), target = number(policy, i);
      EXPECT_NEAR(number(moved, i), before + 0.25f * (target - before), 1e-6f) << name;
      differs |= number(moved, i) != target;
    }
  }
  EXPECT_TRUE(differs);
}

TEST(SacAgent, Bf16StartsWithTheLossesOfF32) {
  if (Precisions().size() < 2) GTEST_SKIP() << "this CPU has no bf16 arithmetic";
  const RandomBatch batch(SmallSpec(), SmallConfig().learner.batch, 3);
  const UpdateOutcome f32 = SmallAgent(SmallConfig())->Update(batch.View());
  const UpdateOutcome bf16 = SmallAgent(SmallConfig(), Precision::kBf16)->Update(batch.View());
  EXPECT_NEAR(Get(bf16, kCriticLoss), Get(f32, kCriticLoss), 0.05 * Get(f32, kCriticLoss));
  EXPECT_NEAR(Get(bf16, kCriticGradNorm), Get(f32, kCriticGradNorm),
              0.1 * Get(f32, kCriticGradNorm));
  EXPECT_NEAR(Get(bf16, kEntropy), Get(f32, kEntropy), 0.05 * std::abs(Get(f32, kEntropy)));
}

double After(const Config& config, int updates, const Figure& figure) {
  const auto agent = SmallAgent(config);
  UpdateOutcome outcome;
  for (int u = 0; u < updates; ++u) {
    outcome = agent->Update(RandomBatch(SmallSpec(), config.learner.batch, uint64_t(u)).View());
  }
  return Get(outcome, figure);
}

TEST(SacAgent, TheTemperatureFollowsIsFixedOrHasAFloor) {
  Config config = SmallConfig();
  config.sac.temperature_learning_rate = 0.1;
  config.sac.target_entropy = -100;  // the policy has more
  const double start = config.sac.initial_temperature;
  const double followed = After(config, 5, kTemperature);
  EXPECT_LT(followed, 0.9 * start) << "the reference for the other cases";
  config.sac.min_temperature = 0.95 * start;
  EXPECT_NEAR(After(config, 5, kTemperature), 0.95 * start, 1e-6);
  config.sac.min_temperature = 0;
  config.sac.temperature = "fixed";
  EXPECT_NEAR(After(config, 5, kTemperature), start, 1e-7);
}

// Eq. 8: L = temperature (entropy - target), before the update's step.
TEST(SacAgent, TheTargetEntropyIsANumberOrAShareOfEachAction) {
  const auto target = [](const std::function<void(SacConfig*)>& set) {
    Config config = SmallConfig();
    set(&config.sac);
    const UpdateOutcome outcome =
        SmallAgent(config)->Update(RandomBatch(SmallSpec(), config.learner.batch, 0).View());
    return Get(outcome, kEntropy) - Get(outcome, kTemperatureLoss) / config.sac.initial_temperature;
  };
  EXPECT_NEAR(target([](SacConfig*) {}), -2, 1e-4) << "one nat less for each of two actions";
  EXPECT_NEAR(target([](SacConfig* sac) { sac->target_entropy = -3; }), -3, 1e-4);
  EXPECT_NEAR(target([](SacConfig* sac) { sac->target_entropy_per_action = -0.5; }), -1, 1e-4);
  EXPECT_NEAR(target([](SacConfig* sac) { sac->target_entropy_per_action = 0; }), 0, 1e-4);
}

TEST(SacAgent, EachPartHasItsLearningRate) {
  const auto moved = [](const std::function<void(Config*)>& set) {
    Config config = SmallConfig();
    set(&config);
    const auto agent = SmallAgent(config);
    const TensorMap before = agent->AllTensors();
    UpdateTimes(agent.get(), 1);
    const TensorMap after = agent->AllTensors();
    const auto largest = [&](const std::string& name) {
      const std::vector<float> a = Floats(before, name), b = Floats(after, name);
      float most = 0;
      for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
      return most;
    };
    return std::array{largest("actor.mlp.output.bias"), largest("critic.q1.output.bias"),
                      largest("encoder.conv1.bias"), largest("temperature.log")};
  };
  // Adam's first step is the learning rate, whatever the gradient.
  const auto all = moved([](Config* c) { c->learner.learning_rate = 1e-3; });
  for (const float step : all) EXPECT_NEAR(step, 1e-3, 2e-5);
  const auto own = moved([](Config* c) {
    c->learner.learning_rate = 1e-3;
    c->learner.actor_learning_rate = 2e-3;
    c->learner.critic_learning_rate = 3e-3;
    c->sac.temperature_learning_rate = 4e-3;
  });
  EXPECT_NEAR(own[0], 2e-3, 4e-5);
  EXPECT_NEAR(own[1], 3e-3, 6e-5);
  EXPECT_NEAR(own[2], 3e-3, 6e-5) << "the encoder is the critic's";
  EXPECT_NEAR(own[3], 4e-3, 8e-5);
}

TEST(SacAgent, ClippingScalesEachOptimisersGradientsDown) {
  Config config = SmallConfig();
  const auto first_moments = [&](double max_norm, const std::string& prefix) {
    config.learner.max_grad_norm = max_norm;
    const auto agent = SmallAgent(config);
    UpdateTimes(agent.get(), 1);
    double squares = 0;
    const TensorMap tensors = agent->AllTensors();
    for (const auto& [name, tensor] : tensors) {
      if (!name.starts_with("adam.m." + prefix)) continue;
      for (const float m : Floats(tensors, name)) squares += double(m) * m;
    }
    return std::sqrt(squares) / 0.1;  // the first step's m is 0.1 g
  };
  for (const char* part : {"actor.", "critic."}) {
    const double norm = first_moments(0, part);
    EXPECT_GT(norm, 1e-3) << part;
    EXPECT_LT(first_moments(1e-3, part), 1.001e-3) << part;
    EXPECT_NEAR(first_moments(100, part), norm, 1e-6 * norm) << part;
  }
}

TEST(SacAgent, AnEnsembleLearnsABandit) {
  Config config;
  config.sac.critics = 5;
  config.sac.target_critics = 2;
  config.sac.actor_value = "mean";
  EXPECT_LT(BanditError(config, MakeAgent), 0.08);
}

TEST(SacAgent, LearnsABandit) { EXPECT_LT(BanditError(Config(), MakeAgent), 0.08); }

}  // namespace
}  // namespace shoal::learner

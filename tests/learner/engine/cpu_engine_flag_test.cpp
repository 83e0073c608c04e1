// SPDX-License-Identifier: Apache-2.0
// The flag of the CPU's engine: steps of optimisers have an effect only while all numbers of an
// update are finite.
#include <gmock/gmock.h>

#include <vector>

#include "tests/learner/engine/cpu_engine_fixture.h"

namespace shoal::learner {
namespace {

using nn::ParameterSet;
using testing::Each;
using testing::ElementsAre;

class FlagTest : public CpuEngineTest {
 protected:
  FlagTest() {
    std::ranges::fill(Of(set_.values()), 1.f);
    std::ranges::fill(Of(set_.gradients()), 2.f);
  }
  using CpuEngineTest::Of;
  static std::span<float> Of(float* values) { return {values, 3}; }
  std::vector<float> Weights() { return {set_.values(), set_.values() + 3}; }
  void Step() {
    engine_.Gather(&adam_, squares_);
    engine_.Step(&adam_, {}, NextUse::kThisUpdate);
  }

  const Number squares_ = Holding(NAN);
  const std::vector<float> before_{1, 1, 1};
};

TEST_F(FlagTest, AStepHasItsEffectWhileAllIsFinite) {
  engine_.Begin(data_.View());
  Step();
  EXPECT_TRUE(engine_.EndAndWait().finite);
  EXPECT_EQ(engine_.Read(squares_), 12);
  EXPECT_NE(Weights(), before_);
  EXPECT_EQ(adam_.steps(), 1u);
}

TEST_F(FlagTest, ABatchThatIsNotFiniteMovesNothing) {
  for (const auto member : {&BatchView::reward, &BatchView::obs_vector, &BatchView::bootstrap}) {
    const RandomBatch faulty(SmallSpec(), kBatch, 4);
    (faulty.View().*member)[1] = NAN;
    engine_.Begin(faulty.View());
    Step();
    ParameterSet average({{"w", {3}}}, ParameterSet::Use::kInference);
    engine_.MoveAverage(0.5f, set_, &average);
    EXPECT_EQ(average.values()[0], 0);
    const Engine::Outcome outcome = engine_.EndAndWait();
    EXPECT_FALSE(outcome.finite);
    EXPECT_FALSE(outcome.batch_finite);
    EXPECT_EQ(Weights(), before_);
    EXPECT_EQ(adam_.steps(), 0u);
  }
}

TEST_F(FlagTest, WhatIsNotFiniteAfterAStepTakesItBack) {
  engine_.Begin(data_.View());
  Step();
  EXPECT_NE(Weights(), before_);
  engine_.RequireFinite(Holding(INFINITY));
  const Engine::Outcome outcome = engine_.EndAndWait();
  EXPECT_FALSE(outcome.finite);
  EXPECT_TRUE(outcome.batch_finite);
  EXPECT_EQ(Weights(), before_);
  EXPECT_EQ(adam_.steps(), 0u);
}

TEST_F(FlagTest, GradientsBeyondTheMomentsRangeMoveNothing) {
  set_.gradients()[1] = 1e25f;  // finite, but its square is not in f32
  engine_.Begin(data_.View());
  Step();
  EXPECT_FALSE(engine_.EndAndWait().finite);
  EXPECT_EQ(Weights(), before_);
}

TEST_F(FlagTest, IsUpAgainInTheNextUpdate) {
  engine_.Begin(data_.View());
  engine_.RequireFinite(Holding(NAN));
  Step();
  EXPECT_FALSE(engine_.EndAndWait().finite);
  engine_.Begin(data_.View());
  Step();
  EXPECT_TRUE(engine_.EndAndWait().finite);
  EXPECT_NE(Weights(), before_);
}

TEST_F(FlagTest, HeldStepsMoveNothingAndTheFlagStaysUp) {
  set_.gradients()[1] = 1e25f;  // unused, so that it does no harm
  ParameterSet average({{"w", {3}}}, ParameterSet::Use::kInference);
  engine_.Begin(data_.View());
  engine_.HoldSteps(Holding(2), 1.5);
  engine_.HoldSteps(Holding(1), 1.5);
  engine_.RequireFinite(Holding(NAN));
  Step();
  engine_.MoveAverage(0.5f, set_, &average);
  const Engine::Outcome outcome = engine_.EndAndWait();
  EXPECT_TRUE(outcome.finite);
  EXPECT_TRUE(outcome.held);
  EXPECT_EQ(Weights(), before_);
  EXPECT_EQ(average.values()[0], 0);
  std::ranges::fill(Of(set_.gradients()), 2.f);
  engine_.Begin(data_.View());
  engine_.HoldSteps(Holding(1.5), 1.5);
  Step();
  EXPECT_FALSE(engine_.EndAndWait().held);
  EXPECT_NE(Weights(), before_);
}

TEST_F(FlagTest, AStepHasTheRateThatItsNumberHoldsThen) {
  const Number factor = engine_.NewNumber();
  const auto moved = [&](double value) {
    const float former = Weights()[0];
    engine_.Set(factor, value);
    engine_.Begin(data_.View());
    engine_.SetRateFactor(factor, &adam_);
    Step();
    engine_.End();
    return former - Weights()[0];
  };
  // Steps of Adam with equal gradients are of the rate's size.
  EXPECT_NEAR(moved(1), 0.1, 1e-5);
  EXPECT_NEAR(moved(0.5), 0.05, 1e-5);
}

TEST_F(FlagTest, MomentsTakeTheVectorsOfFiniteUpdatesAlone) {
  const Moments moments = engine_.NewMoments(1);
  const auto add = [&](double checked) {
    engine_.Begin(data_.View());
    engine_.RequireFinite(Holding(checked));
    engine_.AddToMoments(std::vector<float>{1, 3}, moments);
    engine_.End();
    return engine_.ReadMoments(moments);
  };
  EXPECT_THAT(add(NAN), Each(0));
  EXPECT_THAT(add(1), ElementsAre(2, 2, 2));
  const Array x = Filled(1, 1), y = Poisoned(1);
  engine_.Standardise(x, moments, /*variance_floor=*/4, y);
  for (size_t b = 0; b < kBatch; ++b) EXPECT_NEAR(Of(y)[b], (Of(x)[b] - 2) / 2, kTolerance);
  engine_.SetMoments(moments, std::vector<double>{5, 6, 7});
  EXPECT_THAT(engine_.ReadMoments(moments), ElementsAre(5, 6, 7));
}

TEST_F(FlagTest, NothingIsReadOrSetWithinAnUpdate) {
  const Array array = engine_.NewArray(1);
  engine_.Begin(data_.View());
  EXPECT_DEATH((void)engine_.Read(squares_), "depends on no number that is read");
  EXPECT_DEATH((void)engine_.ReadRows(array), "depends on no array that is read");
  EXPECT_DEATH(engine_.Set(squares_, 1), "updating_");
  EXPECT_DEATH(engine_.Put(std::vector<float>(kBatch), array), "updating_");
  engine_.End();
}

}  // namespace
}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/update_window.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

namespace shoal::learner {
namespace {

UpdateFigures Figures(std::initializer_list<std::pair<const Figure*, double>> list) {
  UpdateFigures figures;
  for (const auto& [figure, value] : list) figures.Set(*figure, value);
  return figures;
}

TEST(UpdateWindow, MeansAreOverItsUpdatesOnly) {
  UpdateWindow window;
  window.Add(Figures({{&kCriticLoss, 100}}));
  window.Clear();
  window.Add(Figures({{&kCriticLoss, 1}, {&kActorGradNorm, 4}}));
  window.Add(Figures({{&kCriticLoss, 2}, {&kActorGradNorm, 8}}));
  EXPECT_EQ(window.updates(), 2);
  EXPECT_EQ(window.Mean().Get(kCriticLoss), 1.5);
  EXPECT_EQ(window.Mean().Get(kActorGradNorm), 6.0);
}

TEST(UpdateWindow, AFigureOfSomeUpdatesIsTheMeanOfThese) {
  UpdateWindow window;
  window.Add(Figures({{&kCriticLoss, 1}, {&kActorLoss, 4}}));
  window.Add(Figures({{&kCriticLoss, 3}}));
  window.Add(Figures({{&kCriticLoss, 5}, {&kActorLoss, 6}}));
  EXPECT_EQ(window.Mean().Get(kCriticLoss), 3.0);
  EXPECT_EQ(window.Mean().Get(kActorLoss), 5.0);
  EXPECT_FALSE(window.Mean().Get(kEntropy));
}

TEST(UpdateWindow, HasNoMeansWhenEmpty) {
  EXPECT_TRUE(UpdateWindow().Mean().empty());
  EXPECT_EQ(UpdateWindow().updates(), 0);
}

TEST(DataAges, AreUpdatesSinceTheWeightsThatActed) {
  std::vector<uint64_t> chosen;
  for (uint64_t i = 1; i <= 100; ++i) chosen.push_back(1000 - i);  // ages 1..100
  QuantileWindow window;
  AddDataAges(chosen, 1000, &window);
  const auto ages = window.Take();
  ASSERT_TRUE(ages);
  EXPECT_EQ(ages->p50, 50);
  EXPECT_EQ(ages->p90, 90);
}

TEST(DataAges, CountPoliciesOfALearnerThatWasAheadAsNew) {
  QuantileWindow window;
  AddDataAges(std::vector<uint64_t>{2000, 2000, 400}, 500, &window);
  const auto ages = window.Take();
  ASSERT_TRUE(ages);
  EXPECT_EQ(ages->p50, 0);
  EXPECT_EQ(ages->p99, 100);
}

}  // namespace
}  // namespace shoal::learner

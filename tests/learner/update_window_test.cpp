#include "learner/update_window.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal::learner {
namespace {

TEST(UpdateWindow, MeansAreOverItsUpdatesOnly) {
  UpdateWindow window;
  window.Add({.critic_loss = 100});
  window.Clear();
  UpdateStats stats;
  stats.critic_loss = 1;
  stats.temperature_loss = -2;
  stats.actor_grad_norm = 4;
  stats.frame_spread = 10;
  window.Add(stats);
  stats.critic_loss = 2;
  stats.actor_grad_norm = 8;
  window.Add(stats);
  EXPECT_EQ(window.updates(), 2);
  EXPECT_FLOAT_EQ(window.Mean().critic_loss, 1.5f);
  EXPECT_FLOAT_EQ(window.Mean().temperature_loss, -2.0f);
  EXPECT_FLOAT_EQ(window.Mean().actor_grad_norm, 6.0f);
  EXPECT_FLOAT_EQ(window.Mean().frame_spread, 10.0f);
}

TEST(UpdateWindow, IsZeroWhenEmpty) {
  EXPECT_EQ(UpdateWindow().Mean().critic_loss, 0.0f);
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

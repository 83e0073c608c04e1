// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/episode_log.h"

#include <gtest/gtest.h>

namespace shoal::actor {
namespace {

TEST(EpisodeLog, MeansAreOverTheLastHundredEpisodes) {
  EpisodeLog log;
  for (int i = 1; i <= 150; ++i) {
    log.Add({.episode_return = double(i), .length = 10, .success = i % 2 == 0});
  }
  EXPECT_EQ(log.count(), 150u);
  EXPECT_NEAR(log.Mean().episode_return, 100.5, 1e-9);
  EXPECT_EQ(log.Mean().length, 10);
  EXPECT_DOUBLE_EQ(log.SuccessRate(), 0.5);
}

TEST(EpisodeLog, AveragesTheMassesDrawn) {
  EpisodeLog log;
  EXPECT_TRUE(log.Mean().drawn_masses.empty());
  log.Add({.drawn_masses = {{"leg", 2}, {"thigh", 4}}});
  log.Add({.drawn_masses = {{"leg", 3}, {"thigh", 5}}});
  const auto masses = log.Mean().drawn_masses;
  ASSERT_EQ(masses.size(), 2u);
  EXPECT_EQ(masses[0].body, "leg");
  EXPECT_DOUBLE_EQ(masses[0].mass_kg, 2.5);
  EXPECT_DOUBLE_EQ(masses[1].mass_kg, 4.5);
}

}  // namespace
}  // namespace shoal::actor

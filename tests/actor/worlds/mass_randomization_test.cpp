// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/mass_randomization.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "actor/worlds/world_environment.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using testing::HasSubstr;

Config Randomized() {
  Config config;
  config.task = "CustomHopper-source";
  config.observation.pixels = false;
  config.observation.proprioception = true;
  config.randomization.body_mass = {
      {"thigh", {3.4, 4.4}}, {"leg", {2.2, 3.2}}, {"foot", {4.5, 5.5}}};
  return config;
}

// An environment whose world stays in view.
struct Player {
  explicit Player(const Config& config) {
    auto made = MakeWorld(config.task, {});
    world = made.get();
    environment = std::make_unique<WorldEnvironment>(tasks::FindTask(config.task), std::move(made),
                                                     config, nullptr);
  }
  void Reset(uint64_t key) { environment->Reset(key, {{}, vector}); }
  void Step() { environment->Step(std::vector<float>(3, 0.25f), {{}, vector}); }
  double Mass(const char* body) const { return world->model().body_mass[world->BodyId(body)]; }

  World* world;
  std::unique_ptr<WorldEnvironment> environment;
  std::vector<float> vector = std::vector<float>(11);
};

TEST(MassRandomization, DrawsEachEpisodesMassesUniformlyAndRecordsThem) {
  Player player(Randomized());
  constexpr int kEpisodes = 400;
  double sum = 0, lowest = 10, highest = 0;
  for (uint64_t episode = 0; episode < kEpisodes; ++episode) {
    player.Reset(episode);
    const auto drawn = player.environment->drawn_masses();
    ASSERT_EQ(drawn.size(), 3u);
    EXPECT_EQ(drawn[0].body, "foot");  // in alphabetical order
    EXPECT_EQ(drawn[1].body, "leg");
    EXPECT_EQ(drawn[2].body, "thigh");
    for (const DrawnMass& mass : drawn) EXPECT_EQ(mass.mass_kg, player.Mass(mass.body.c_str()));
    sum += drawn[2].mass_kg / kEpisodes;
    lowest = std::min(lowest, drawn[2].mass_kg);
    highest = std::max(highest, drawn[2].mass_kg);
  }
  // The mean of 400 uniform numbers from an interval of 1 kg: 5 sigma are 5 / sqrt(12 * 400).
  EXPECT_NEAR(sum, 3.9, 0.073);
  EXPECT_GE(lowest, 3.4);
  EXPECT_LT(lowest, 3.42);
  EXPECT_LE(highest, 4.4);
  EXPECT_GT(highest, 4.38);
}

TEST(MassRandomization, LeavesOtherBodiesAndInertiasAlone) {
  Player player(Randomized());
  const auto modelled = MakeWorld("CustomHopper-source", {});
  player.Reset(5);
  EXPECT_NE(player.Mass("leg"), modelled->model().body_mass[modelled->BodyId("leg")]);
  EXPECT_EQ(player.Mass("torso"), modelled->model().body_mass[modelled->BodyId("torso")]);
  for (int i = 0; i < 3 * modelled->model().nbody; ++i) {
    EXPECT_EQ(player.world->model().body_inertia[i], modelled->model().body_inertia[i]) << i;
  }
}

TEST(MassRandomization, InterleavedEnvironmentsDoNotTouchEachOther) {
  Player alone(Randomized());
  alone.Reset(7);
  const double mass = alone.Mass("thigh");
  for (int i = 0; i < 10; ++i) alone.Step();

  Player left(Randomized()), right(Randomized());
  left.Reset(7);
  right.Reset(8);
  EXPECT_EQ(left.Mass("thigh"), mass);
  EXPECT_NE(right.Mass("thigh"), mass);
  for (int i = 0; i < 10; ++i) {
    right.Step();
    left.Step();
    if (i == 4) right.Reset(9);
  }
  EXPECT_EQ(left.Mass("thigh"), mass);
  EXPECT_EQ(left.vector, alone.vector);
  EXPECT_NE(right.vector, alone.vector);
}

TEST(MassRandomization, TheMassesMatterToTheMotion) {
  Config light = Randomized(), heavy = Randomized();
  light.randomization.body_mass = {{"thigh", {3.4, 3.4}}};
  heavy.randomization.body_mass = {{"thigh", {4.4, 4.4}}};
  Player a(light), b(heavy);
  for (Player* player : {&a, &b}) {
    player->Reset(1);
    for (int i = 0; i < 10; ++i) player->Step();
  }
  EXPECT_NE(a.vector, b.vector);
}

TEST(MassRandomization, WithoutIntervalsNothingIsDrawn) {
  Config config = Randomized();
  config.randomization.body_mass.clear();
  Player player(config);
  player.Reset(1);
  EXPECT_TRUE(player.environment->drawn_masses().empty());
}

TEST(MassRandomization, RefusesAnUnknownBodyByNameAndListsThoseThereAre) {
  Config config = Randomized();
  config.randomization.body_mass["tail"] = {1, 2};
  try {
    Player player(config);
    FAIL() << "randomized a body that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), HasSubstr("'tail'"));
    EXPECT_THAT(error.what(), HasSubstr("torso, thigh, leg, foot"));
  }
}

}  // namespace
}  // namespace shoal::worlds

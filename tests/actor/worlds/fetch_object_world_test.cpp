// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_object_world.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "actor/worlds/world_registry.h"
#include "tests/actor/worlds/engine_warnings.h"

namespace shoal::worlds {
namespace {

struct Published {
  const char* name;
  std::array<double, 3> initial_grip;
  double table_height;
  double object_range, goal_range, goal_offset_x;
  bool in_the_air, fingers_move;
};

void PrintTo(const Published& task, std::ostream* out) { *out << task.name; }

// Values of the original environments on the same engine.
constexpr Published kPublished[] = {{"FetchPush",
                                     {1.3482057674, 0.7489488419, 0.4136182913},
                                     0.4246997495,
                                     0.15,
                                     0.15,
                                     0,
                                     false,
                                     false},
                                    {"FetchSlide",
                                     {0.9961198291, 0.7489058673, 0.4126661756},
                                     0.4140189435,
                                     0.1,
                                     0.3,
                                     0.4,
                                     false,
                                     false},
                                    {"FetchPickAndPlace",
                                     {1.3419550217, 0.7491004959, 0.5347069463},
                                     0.4246997495,
                                     0.15,
                                     0.15,
                                     0,
                                     true,
                                     true}};

struct Blocks {
  std::array<double, 25> observation{};
  std::array<double, 3> achieved{}, desired{};
};

Blocks Observe(const World& world) {
  Blocks blocks;
  world.Observe(blocks.observation, blocks.achieved, blocks.desired);
  return blocks;
}

void Append(const World& world, std::vector<double>* seen) {
  const Blocks blocks = Observe(world);
  seen->insert(seen->end(), blocks.observation.begin(), blocks.observation.end());
  seen->insert(seen->end(), blocks.desired.begin(), blocks.desired.end());
}

std::array<double, 4> Draw(Random* random) {
  std::array<double, 4> action{};
  for (double& component : action) component = random->Uniform(-1, 1);
  return action;
}

// Every number of every observation of an episode.
std::vector<double> Episode(World* world, uint64_t key, int steps) {
  Random random(key);
  world->Reset(&random);
  std::vector<double> seen;
  Append(*world, &seen);
  for (int step = 0; step < steps; ++step) {
    world->Step(Draw(&random));
    Append(*world, &seen);
  }
  return seen;
}

class FetchObject : public testing::TestWithParam<Published> {
 protected:
  std::unique_ptr<FetchObjectWorld> Make() const {
    std::unique_ptr<World> world = MakeWorld(GetParam().name, {});
    return std::unique_ptr<FetchObjectWorld>(dynamic_cast<FetchObjectWorld*>(world.release()));
  }
};

INSTANTIATE_TEST_SUITE_P(Tasks, FetchObject, testing::ValuesIn(kPublished),
                         [](const auto& task) { return std::string(task.param.name); });

TEST_P(FetchObject, StartsWhereTheOriginalDoes) {
  const auto world = Make();
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(world->arm().initial_grip()[i], GetParam().initial_grip[i], 1e-8) << i;
  }
  EXPECT_NEAR(world->table_height(), GetParam().table_height, 1e-10);
  const mjModel& model = world->model();
  EXPECT_EQ(model.nq, 22);
  EXPECT_EQ(model.nv, 21);
  EXPECT_EQ(model.nu, GetParam().fingers_move ? 2 : 0);
}

TEST_P(FetchObject, HasTheMassesOfTheOriginal) {
  const auto world = Make();
  const mjModel& model = world->model();
  double mass = 0;
  for (int i = 0; i < model.nbody; ++i) mass += model.body_mass[i];
  EXPECT_NEAR(mass, 2122.5175, 1e-3);
  EXPECT_NEAR(model.stat.meaninertia, 31.1978, 1e-4);
  const int object = world->BodyId("object0");
  EXPECT_NEAR(model.body_mass[object], 2, 1e-12);
  EXPECT_NEAR(model.body_invweight0[2 * object], 0.5, 1e-9);
}

// docs/worlds.md, pictures of goals.
TEST_P(FetchObject, ShowsItsGoalReachedAndTheGripperByItsRule) {
  const auto world = Make();
  const std::string task = GetParam().name;
  Random random(11);
  for (int episode = 0; episode < 20; ++episode) {
    world->Reset(&random);
    const Blocks before = Observe(*world);
    const double time = world->data().time;
    Blocks shown;
    world->LookAtGoal([&] { shown = Observe(*world); });
    const std::array<double, 3> grip{shown.observation[0], shown.observation[1],
                                     shown.observation[2]};
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(shown.achieved[i], before.desired[i], 1e-9);
      const double above = task == "FetchPush" && i == 2 ? 0.1 : 0;
      const double expected =
          task == "FetchSlide" ? before.observation[i] : before.desired[i] + above;
      EXPECT_NEAR(grip[i], expected, task == "FetchSlide" ? 1e-9 : 5e-3) << task << ", " << i;
    }
    const Blocks after = Observe(*world);
    EXPECT_EQ(after.observation, before.observation);
    EXPECT_EQ(after.achieved, before.achieved);
    EXPECT_EQ(world->data().time, time);
  }
}

// Means of n uniforms over a width w have sigma w / sqrt(12 n).
TEST_P(FetchObject, GoalsAndObjectsFillTheirRangesAndNothingElse) {
  const Published& task = GetParam();
  const auto world = Make();
  const std::array<double, 3>& grip = world->arm().initial_grip();
  constexpr int kDraws = 400;
  std::array<double, 2> goal_sum{}, goal_far{}, object_far{};
  int raised = 0;
  Random random(7);
  for (int i = 0; i < kDraws; ++i) {
    world->Reset(&random);
    const Blocks blocks = Observe(*world);
    const std::array<double, 2> object{blocks.achieved[0] - grip[0], blocks.achieved[1] - grip[1]};
    EXPECT_GE(std::hypot(object[0], object[1]), 0.1 - 1e-9);
    for (size_t axis = 0; axis < 2; ++axis) {
      const double offset =
          blocks.desired[axis] - grip[axis] - (axis == 0 ? task.goal_offset_x : 0);
      goal_sum[axis] += offset;
      goal_far[axis] = std::max(goal_far[axis], std::fabs(offset));
      object_far[axis] = std::max(object_far[axis], std::fabs(object[axis]));
    }
    const double height = blocks.desired[2] - world->table_height();
    EXPECT_GE(height, 0);
    EXPECT_LE(height, task.in_the_air ? 0.45 : 0);
    raised += height > 0;
  }
  const double sigma = 2 * task.goal_range / std::sqrt(12.0 * kDraws);
  for (size_t axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(goal_sum[axis] / kDraws, 0, 5 * sigma) << axis;
    EXPECT_LE(goal_far[axis], task.goal_range + 1e-9) << axis;
    EXPECT_GT(goal_far[axis], 0.95 * task.goal_range) << axis;
    EXPECT_LE(object_far[axis], task.object_range + 1e-9) << axis;
    EXPECT_GT(object_far[axis], 0.95 * task.object_range) << axis;
  }
  const double coin_sigma = std::sqrt(0.25 / kDraws);
  EXPECT_NEAR(double(raised) / kDraws, task.in_the_air ? 0.5 : 0, 5 * coin_sigma);
}

TEST_P(FetchObject, DrawsComeInTheDocumentedOrder) {
  const Published& task = GetParam();
  const auto world = Make();
  const std::array<double, 3>& grip = world->arm().initial_grip();
  Random random(11), same(11);
  for (int episode = 0; episode < 20; ++episode) {
    world->Reset(&random);
    const Blocks blocks = Observe(*world);
    double x = 0, y = 0;
    do {
      x = grip[0] + same.Uniform(-task.object_range, task.object_range);
      y = grip[1] + same.Uniform(-task.object_range, task.object_range);
    } while (std::hypot(x - grip[0], y - grip[1]) < 0.1);
    std::array<double, 3> goal = grip;
    for (double& coordinate : goal) coordinate += same.Uniform(-task.goal_range, task.goal_range);
    goal[0] += task.goal_offset_x;
    goal[2] = world->table_height();
    if (task.in_the_air && same.Uniform() < 0.5) goal[2] += same.Uniform(0, 0.45);
    EXPECT_EQ(blocks.desired, goal);
    EXPECT_NEAR(blocks.achieved[0], x, 1e-12);
    EXPECT_NEAR(blocks.achieved[1], y, 1e-12);
    EXPECT_EQ(random.state(), same.state());
  }
}

TEST_P(FetchObject, TheAchievedGoalIsTheObjectAndTheMarkerIsAtTheGoal) {
  const auto world = Make();
  const std::array<double, 3> goal{1.25, 0.85, 0.5};
  world->ResetTo(goal, {1.4, 0.65});
  world->Step(std::array<double, 4>{0.2, -0.4, 0.6, 0});
  const Blocks blocks = Observe(*world);
  const double* object = world->data().site_xpos + 3 * world->SiteId("object0");
  const double* marker = world->data().site_xpos + 3 * world->SiteId("target0");
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(blocks.achieved[axis], object[axis]);
    EXPECT_EQ(blocks.observation[3 + axis], object[axis]);
    EXPECT_EQ(blocks.observation[6 + axis], object[axis] - blocks.observation[axis]);
    EXPECT_NEAR(marker[axis], goal[axis], 1e-12);
  }
}

TEST_P(FetchObject, OnlyAnUnblockedGripperOpens) {
  const auto world = Make();
  world->ResetTo({1.25, 0.85, 0.5}, {1.4, 0.65});
  for (int i = 0; i < 5; ++i) world->Step(std::array<double, 4>{0, 0, 1, 1});
  const Blocks blocks = Observe(*world);
  if (GetParam().fingers_move) {
    EXPECT_GT(blocks.observation[9], 0.01);
    EXPECT_GT(blocks.observation[10], 0.01);
  } else {
    EXPECT_EQ(blocks.observation[9], 0);
    EXPECT_EQ(blocks.observation[10], 0);
  }
}

TEST_P(FetchObject, AnEpisodeDoesNotDependOnTheOnesBefore) {
  const auto fresh = Make(), used = Make();
  Episode(used.get(), 1, 10);
  Episode(used.get(), 2, 3);
  const std::vector<double> episode = Episode(fresh.get(), 3, 10);
  EXPECT_EQ(Episode(used.get(), 3, 10), episode);
  EXPECT_NE(Episode(fresh.get(), 4, 10), episode);
}

// Neither the state nor what a model holds (masses, the marker) is shared.
TEST_P(FetchObject, InterleavedWorldsDoNotTouchEachOther) {
  const auto alone = Make(), left = Make(), right = Make();
  const std::vector<double> expected = Episode(alone.get(), 5, 8);
  right->model().body_mass[right->BodyId("object0")] = 7;
  Random random(5), other(6);
  left->Reset(&random);
  std::vector<double> seen;
  Append(*left, &seen);
  for (int step = 0; step < 8; ++step) {
    right->Reset(&other);
    right->Step(Draw(&other));
    left->Step(Draw(&random));
    Append(*left, &seen);
  }
  EXPECT_EQ(seen, expected);
}

TEST_P(FetchObject, RunsWithoutEngineWarnings) {
  ExpectEngineWarnings(0);
  const auto world = Make();
  Episode(world.get(), 8, 50);
}

}  // namespace
}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// The six tasks of the Control Suite: models, starts, episodes, rewards.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>

#include "actor/worlds/control_world.h"
#include "actor/worlds/world_environment.h"
#include "actor/worlds/world_registry.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

double Mass(const World& world, const char* body) {
  return world.model().body_mass[world.BodyId(body)];
}

// Published values, with all published digits.
TEST(ControlTasks, MassesAreThoseOfTheOriginals) {
  const struct {
    const char *task, *body;
    double mass;
  } rows[] = {{"reacher_easy", "arm", .0418879},        {"reacher_easy", "hand", .0356047},
              {"reacher_easy", "finger", .00418879},    {"cheetah_run", "torso", 6.2502092},
              {"cheetah_run", "bthigh", 1.5435146},     {"cheetah_run", "ffoot", .88451883},
              {"ball_in_cup_catch", "cup", .065152914}, {"ball_in_cup_catch", "ball", .065449847},
              {"finger_spin", "proximal", .83345196},   {"finger_spin", "distal", .68678148},
              {"finger_spin", "spinner", 2.4588199},    {"walker_walk", "torso", 10.673037},
              {"walker_walk", "right_leg", 2.7813567},  {"walker_walk", "left_foot", 2.0943951},
              {"cartpole_swingup", "cart", 1},          {"cartpole_swingup", "pole_1", .1}};
  for (const auto& row : rows) {
    const auto world = MakeWorld(row.task, {});
    EXPECT_NEAR(Mass(*world, row.body), row.mass, 1e-6 * row.mass) << row.task << ' ' << row.body;
  }
}

class ControlTask : public testing::TestWithParam<const char*> {
 protected:
  const tasks::Task& task_ = tasks::FindTask(GetParam());

  std::unique_ptr<WorldEnvironment> Make(int action_repeat) const {
    Config config;
    config.action_repeat = action_repeat;
    return std::make_unique<WorldEnvironment>(task_, MakeWorld(GetParam(), {}), config, nullptr);
  }
};

struct Episode {
  double episode_return = 0;
  int env_steps = 0;
  std::vector<float> last;
};

Episode Play(const tasks::Task& task, Environment* environment, uint64_t key) {
  Episode episode;
  episode.last.resize(size_t(task.observation().size()));
  environment->Reset(key, {{}, episode.last});
  const std::vector<float> action(size_t(task.action_size()), 0.3f);
  StepResult result;
  while (!result.truncated) {
    result = environment->Step(action, {{}, episode.last});
    EXPECT_FALSE(result.terminated);
    EXPECT_FALSE(result.success);
    EXPECT_TRUE(std::isnan(result.distance));
    episode.episode_return += result.reward;
    ++episode.env_steps;
  }
  return episode;
}

TEST_P(ControlTask, AnEpisodeIsAThousandControlStepsWhateverTheRepeat) {
  const Episode single = Play(task_, Make(1).get(), 4);
  EXPECT_EQ(single.env_steps, 1000);
  EXPECT_GE(single.episode_return, 0);
  EXPECT_LE(single.episode_return, 1000);
  for (const int repeat : {task_.action_repeat(), 6}) {
    const Episode repeated = Play(task_, Make(repeat).get(), 4);
    EXPECT_EQ(repeated.env_steps, (1000 + repeat - 1) / repeat);
    EXPECT_EQ(repeated.env_steps, task_.EnvStepsPerEpisode(repeat));
    EXPECT_NEAR(repeated.episode_return, single.episode_return, 1e-3);
    EXPECT_EQ(repeated.last, single.last);
  }
}

TEST_P(ControlTask, ZeroRepeatsAsOftenAsTheTaskItselfDoes) {
  EXPECT_GT(task_.action_repeat(), 1);
  EXPECT_EQ(Play(task_, Make(0).get(), 4).env_steps,
            task_.EnvStepsPerEpisode(task_.action_repeat()));
}

TEST_P(ControlTask, EqualKeysGiveEqualEpisodesWhateverHappenedBefore) {
  const auto fresh = Make(0), used = Make(0);
  Play(task_, used.get(), 11);
  const Episode expected = Play(task_, fresh.get(), 12);
  const Episode again = Play(task_, used.get(), 12);
  EXPECT_EQ(again.last, expected.last);
  EXPECT_EQ(again.episode_return, expected.episode_return);
  EXPECT_NE(Play(task_, used.get(), 13).last, expected.last);
}

INSTANTIATE_TEST_SUITE_P(Six, ControlTask,
                         testing::Values("cartpole_swingup", "reacher_easy", "cheetah_run",
                                         "ball_in_cup_catch", "finger_spin", "walker_walk"),
                         [](const auto& name) { return std::string(name.param); });

TEST(ControlTasks, ThosesThatRedrawStartWithoutContact) {
  for (const char* name : {"ball_in_cup_catch", "finger_spin"}) {
    const auto world = MakeWorld(name, {});
    Random random(2);
    for (int episode = 0; episode < 50; ++episode) {
      world->Reset(&random);
      EXPECT_EQ(world->data().ncon, 0) << name;
    }
  }
}

TEST(ControlTasks, ThePoleHangsAtTheStart) {
  const auto world = MakeWorld("cartpole_swingup", {});
  Random random(1);
  for (int episode = 0; episode < 20; ++episode) {
    world->Reset(&random);
    std::array<double, 5> observation{};
    world->Observe(observation, {}, {});
    EXPECT_LT(observation[1], -0.99);
    EXPECT_LT(std::fabs(observation[0]), 0.06);
  }
}

TEST(ControlTasks, AnUprightPoleInTheMiddleEarnsOneAndAHangingOneNothing) {
  const auto world = MakeWorld("cartpole_swingup", {});
  auto& cartpole = dynamic_cast<ControlWorld&>(*world);
  const std::array<double, 2> up{0, 0}, down{0, M_PI}, still{};
  cartpole.ResetTo(up, still);
  EXPECT_NEAR(world->Step(std::array<double, 1>{}).reward, 1, 1e-4);
  // Effort costs a fifth at most: (4 + 0) / 5.
  cartpole.ResetTo(up, still);
  EXPECT_NEAR(world->Step(std::array<double, 1>{1}).reward, 0.8, 0.01);
  cartpole.ResetTo(down, still);
  EXPECT_NEAR(world->Step(std::array<double, 1>{}).reward, 0, 1e-6);
}

TEST(ControlTasks, TheReachersTargetLiesWhereItCanBeReachedAndMovesEachEpisode) {
  const auto world = MakeWorld("reacher_easy", {});
  const double* target = world->model().geom_pos + 3 * world->GeomId("target");
  Random random(6);
  double nearest = 1, farthest = 0;
  for (int episode = 0; episode < 300; ++episode) {
    world->Reset(&random);
    const double radius = std::hypot(target[0], target[1]);
    nearest = std::min(nearest, radius);
    farthest = std::max(farthest, radius);
  }
  EXPECT_GE(nearest, 0.05 - 1e-12);
  EXPECT_LT(nearest, 0.055);
  EXPECT_LE(farthest, 0.2 + 1e-12);
  EXPECT_GT(farthest, 0.195);
}

TEST(ControlTasks, TheSpinnersHingeIsTheSpinTasks) {
  const auto world = MakeWorld("finger_spin", {});
  const int hinge = world->model().jnt_dofadr[world->JointId("hinge")];
  EXPECT_EQ(world->model().dof_damping[hinge], 0.03);
  EXPECT_EQ(world->model().site_rgba[4 * world->SiteId("tip") + 3], 0);
}

TEST(ControlTasks, EachHasTheCamerasOfItsModelByName) {
  const struct {
    const char* task;
    std::vector<std::string> names;
  } rows[] = {{"cartpole_swingup", {"fixed", "lookatcart"}},
              {"reacher_easy", {"fixed", "hand"}},
              {"cheetah_run", {"side", "back"}},
              {"ball_in_cup_catch", {"cam0", "cam1"}},
              {"finger_spin", {"cam0", "cam1"}},
              {"walker_walk", {"side", "back"}}};
  for (const auto& row : rows) {
    const auto world = MakeWorld(row.task, {});
    std::vector<std::string> names;
    for (const CameraView& camera : world->cameras()) {
      EXPECT_EQ(camera.model_camera, int(names.size()));
      names.push_back(camera.name);
    }
    EXPECT_EQ(names, row.names) << row.task;
  }
}

}  // namespace
}  // namespace shoal::worlds

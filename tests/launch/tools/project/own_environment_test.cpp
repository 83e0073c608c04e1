// SPDX-License-Identifier: Apache-2.0
// The example in C++ of docs/own_environment.md: built with an installation and run by it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/launch/tools/project/installed_shoal.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kSmall[] =
    " --set actors=1 --set learner.threads=1 --set env_steps=1200 --set replay.min_size=200"
    " --set learner.batch=32 --set 'network.hidden=[32]' --set eval.interval=600"
    " --set eval.episodes=2 --set eval.final_episodes=2 --set stop.success=2";

class OwnEnvironment : public InstalledShoal {
 protected:
  // Builds `source`, a folder, into Folder() / name.
  static void Build(const fs::path& source, const std::string& name) {
    Expect(RunIn(Folder(), "cmake -S " + source.string() + " -B " + name + " -DCMAKE_PREFIX_PATH=" +
                               Prefix().string() + " && cmake --build " + name));
  }
};

TEST_F(OwnEnvironment, IsBuiltTrainedAndFilmedWithAnInstallation) {
  Build(SourcePath("docs/examples/own_environment_cpp"), "built");
  const std::string environment = "built/catch_light.so:CatchLight";
  const ProgramResult libraries = RunIn(Folder(), "ldd built/catch_light.so");
  Expect(libraries);
  EXPECT_THAT(libraries.out, Not(HasSubstr("mujoco"))) << "it has no engine";

  const ProgramResult checked = RunIn(Folder(), Shoal() + " env check " + environment);
  Expect(checked);
  EXPECT_THAT(checked.out, AllOf(HasSubstr("run by shoal-actor"), HasSubstr("cart: 2 in [-10, 10]"),
                                 HasSubstr("episodes of at most 100 steps; steps report success"),
                                 HasSubstr("OK    equal seeds and actions gave equal episodes")));
  const ProgramResult described = RunIn(Folder(), Shoal() + " env describe " + environment);
  Expect(described);
  EXPECT_THAT(described.out, HasSubstr("number 0: -2 + (a + 1) / 2 * 4, in [-2, 2]"));

  const ProgramResult trained =
      RunIn(Folder(), Shoal() + " train --env " + environment + " --name light" + kSmall);
  Expect(trained);
  EXPECT_THAT(trained.out, HasSubstr("preset state, because it observes no image"));
  const auto meta = nlohmann::json::parse(ReadFile(Folder() / "runs/light/meta.json"));
  EXPECT_EQ(meta.at("task"), "catch_light.CatchLight");
  EXPECT_TRUE(meta.at("accounting").at("balances"));
  EXPECT_GT(meta.at("updates").get<int64_t>(), 10);
  Expect(RunIn(Folder(), Shoal() + " eval light --episodes 2"));
  Expect(RunIn(Folder(), Shoal() + " film light --episodes 1"));
  EXPECT_GT(fs::file_size(Folder() / "runs/light/videos/best.mp4"), 1000U);
  Expect(RunIn(Folder(), Shoal() + " train --resume light --set env_steps=1400"));
}

// A goal that does not give the rewards, a library without its entry point, a name it has not.
TEST_F(OwnEnvironment, IsRefusedByName) {
  const fs::path source = Folder() / "wrong";
  fs::create_directories(source);
  std::ofstream(source / "CMakeLists.txt")
      << "cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES CXX)\n"
         "find_package(Shoal REQUIRED)\nshoal_environment_library(wrong wrong.cpp)\n"
         "shoal_environment_library(empty empty.cpp)\n";
  std::ofstream(source / "empty.cpp") << "int nothing;\n";
  std::ofstream(source / "wrong.cpp") << R"(
#include <array>
#include "actor/hosted/environment_library.h"
struct Wrong final : shoal::hosted::OwnEnvironment {
  shoal::tasks::EnvironmentDescription Describe() const override {
    shoal::tasks::EnvironmentDescription description;
    description.episode_steps = 5;
    description.action = {.name = "push", .shape = {1}, .low = {-1}, .high = {1}};
    for (const char* name : {"achieved_goal", "desired_goal"}) {
      description.observation.push_back({.name = name, .shape = {1}, .low = {-1}, .high = {1}});
    }
    description.goal = {.reward = shoal::tasks::RewardKind::kSparse, .threshold = 0.1};
    return description;
  }
  void Reset(uint32_t) override {}
  shoal::hosted::RawStep Step(std::span<const double>) override { return {.reward = 7}; }
  std::span<const void* const> observation() const override { return arrays; }
  float place = 0, goal = 0.5F;
  std::array<const void*, 2> arrays{&place, &goal};
};
std::unique_ptr<shoal::hosted::OwnEnvironment> Make(const std::string&) {
  return std::make_unique<Wrong>();
}
extern "C" void ShoalRegisterEnvironments() { shoal::hosted::AddEnvironment("Wrong", Make); }
)";
  Build(source, "wrong_built");
  const auto train = [&](const std::string& environment, const std::string& words = "") {
    return RunIn(Folder(),
                 Shoal() + " train --env " + environment + " --name wrong" + kSmall + words);
  };
  const ProgramResult rewards =
      train("wrong_built/wrong.so:Wrong", " --set replay.hindsight=future");
  EXPECT_EQ(ExitCode(rewards), 2) << rewards.out;
  EXPECT_THAT(rewards.err,
              HasSubstr("the reward of step 1 is 7, where a distance of 0.5 gives -1"));
  const std::pair<const char*, const char*> refusals[] = {
      {"wrong_built/wrong.so:Right", "has no environment 'Right'; expected Wrong"},
      {"wrong_built/empty.so:Wrong", "has no entry point ShoalRegisterEnvironments"},
      {"wrong_built/nowhere.so:Wrong", "file 'wrong_built/nowhere.so' does not exist"},
      {"wrong_built/wrong.so", "expected wrong_built/wrong.so:NAME"},
      {"wrong/wrong.cpp.so:Wrong", "does not exist"}};
  for (const auto& [environment, expected] : refusals) {
    const ProgramResult refused = train(environment);
    EXPECT_EQ(ExitCode(refused), 2) << environment << refused.out;
    EXPECT_THAT(refused.err, HasSubstr(expected)) << environment;
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  }
  EXPECT_FALSE(fs::exists(Folder() / "runs/wrong"));
}

}  // namespace
}  // namespace shoal

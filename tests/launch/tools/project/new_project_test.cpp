// SPDX-License-Identifier: Apache-2.0
// A user's project that is made, built and trained with an installation, from another folder.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/base/files.h"
#include "tests/launch/tools/project/installed_shoal.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class NewProject : public InstalledShoal {};

TEST_F(NewProject, AnInstallationHasItsPartsWhereTheyBelong) {
  for (const char* file :
       {"bin/shoal", "bin/shoal-actor", "bin/shoal-learner", "bin/shoal-replay",
        "share/shoal/presets/fetch-reach-drq.json", "share/shoal/experiments/reach-three-way.json",
        "share/shoal/references/planet-6.json", "share/shoal/grafana/shoal.json",
        "share/shoal/config.schema.json", "share/shoal/template/task/goal.cpp",
        "share/man/man1/shoal.1.gz", "share/man/man5/shoal-configuration.5.gz",
        "share/bash-completion/completions/shoal-actor", "share/zsh/vendor-completions/_shoal",
        "share/fish/vendor_completions.d/shoal.fish", "include/shoal/actor/worlds/world.h",
        "share/doc/shoal/examples/shoal-train@.service"}) {
    EXPECT_TRUE(fs::is_regular_file(Prefix() / file)) << file;
  }
}

TEST_F(NewProject, AnInstallationFindsItsPresetsFromAnyFolderWithoutTheSources) {
  const ProgramResult result =
      RunIn("/", Shoal() + " train --preset fetch-reach-state --print-config");
  Expect(result);
  EXPECT_EQ(nlohmann::json::parse(result.out).at("preset"), "fetch-reach-state");
  const std::string program = ReadFile(Shoal());
  for (const char* folder :
       {"launch/data/presets", "launch/data/experiments", "launch/data/references"}) {
    EXPECT_EQ(program.find(SourcePath(folder)), std::string::npos) << folder;
  }
}

TEST_F(NewProject, BuildsAndTrainsAgainstTheInstallation) {
  Expect(RunIn(Folder(), Shoal() + " new robot"));
  const fs::path robot = Folder() / "robot";
  Expect(RunIn(robot, "cmake -B build -DCMAKE_PREFIX_PATH=" + Prefix().string() +
                          " && cmake --build build"));
  const ProgramResult random = RunIn(
      robot, Shoal() + " env random PointReachDense --episodes 2 --task-library build/tasks.so");
  Expect(random);
  EXPECT_THAT(random.out, HasSubstr("PointReachDense"));
  Expect(RunIn(robot, Shoal() + " experiment run point-reach --dry-run"));
  Expect(RunIn(robot, Shoal() + " train --preset point-reach --set actors=1 --set env_steps=800"
                                " --set eval.interval=400 --set eval.episodes=2"
                                " --set eval.final_episodes=2 --set learner.threads=1"));
  const auto meta = nlohmann::json::parse(ReadFile(robot / "runs/point-reach-s1/meta.json"));
  EXPECT_EQ(meta.at("task"), "PointReachDense");
  EXPECT_GT(meta.at("updates").get<int64_t>(), 10);
}

// In a clone nothing is installed: the printed command line is run as it is.
TEST_F(NewProject, ItsPrintedCommandsBuildAgainstTheBuildFolder) {
  const std::string shoal = ProgramPath("shoal");
  const ProgramResult made = RunIn(Folder(), shoal + " new 'my robot'");
  Expect(made);
  const std::string next = made.out.substr(made.out.find("next: ") + 6);
  EXPECT_THAT(next, HasSubstr("-DCMAKE_PREFIX_PATH="));
  const std::string build = next.substr(0, next.find(" && shoal train"));
  Expect(RunIn(Folder(), build));
  EXPECT_TRUE(fs::exists(Folder() / "my robot/build/tasks_physics.so"));
}

TEST_F(NewProject, RefusesAFolderThatIsThereOrHasNoParent) {
  fs::create_directory(Folder() / "taken");
  const ProgramResult taken = RunIn(Folder(), Shoal() + " new taken/");
  EXPECT_EQ(ExitCode(taken), 2);
  EXPECT_THAT(taken.err, HasSubstr("taken/: it exists already"));
  const ProgramResult nowhere = RunIn(Folder(), Shoal() + " new no/where");
  EXPECT_EQ(ExitCode(nowhere), 2);
  EXPECT_THAT(nowhere.err, HasSubstr("no/where: there is no folder"));
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// `./run train`: errors for wrong arguments before a build, and the output of a build.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/program.h"
#include "tests/support/terminal_program.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

// A checkout with installed packages and with scripts in place of the tools, so that only the
// script `run` is tested.
class RunScript : public testing::Test {
 protected:
  RunScript() {
    MakeFolders(tree_ / "launch" / "data" / "presets");
    for (const char* room : {"actor", "common", "learner", "replay_server"}) {
      MakeFolders(tree_ / room);
    }
    fs::copy(SourcePath("run"), tree_ / "run");
    WriteFileAtomically(tree_ / "CMakeLists.txt", "");
    WriteFileAtomically(tree_ / "launch" / "data" / "presets" / "fetch-reach-fast.json", "{}");
    Tool("dpkg-query", "echo -n installed");
    Tool("cmake", "exit 0");
    Tool("ninja",
         "echo 'ninja: Entering directory'; echo '[0/2] Re-checking globbed directories...'; "
         "echo '[1/2] Building a.cpp'; echo 'a.cpp: a warning'; echo '[2/2] Linking a'; echo "
         "built >> " +
             (tree_ / "built").string());
  }

  void Tool(const std::string& name, const std::string& script) const {
    Program(tree_ / "tools" / name, script);
  }
  static void Program(const fs::path& file, const std::string& script) {
    MakeFolders(file.parent_path());
    WriteFileAtomically(file, "#!/bin/sh\n" + script + "\n");
    fs::permissions(file, fs::perms::owner_all);
  }
  // `shoal` of an earlier build: refuses the argument "wrong".
  void Built() const {
    Program(tree_ / "build/release/bin/shoal",
            "case \"$*\" in *wrong*) echo 'shoal: error: wrong' >&2; exit 2;; esac\n"
            "echo \"$*\" >> " +
                (tree_ / "trained").string());
  }
  ProgramResult Train(std::vector<std::string> arguments) const {
    std::vector<std::string> command{"/bin/bash", tree_ / "run", "train"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return RunCommand(command, seconds(30), {{"PATH", Path()}});
  }
  std::string Path() const { return (tree_ / "tools").string() + ":" + std::getenv("PATH"); }
  bool WasBuilt() const { return fs::exists(tree_ / "built"); }

  const TemporaryFolder folder_;
  const fs::path tree_ = folder_.path() / "tree";
};

TEST_F(RunScript, ProgramsThatAreBuiltRefuseArgumentsBeforeABuild) {
  Built();
  const ProgramResult refused = Train({"--wrong"});
  EXPECT_EQ(ExitCode(refused), 2);
  EXPECT_EQ(refused.err, "shoal: error: wrong\n");
  EXPECT_FALSE(WasBuilt());
  const ProgramResult good = Train({"--seed", "3", "--film"});
  EXPECT_EQ(ExitCode(good), 0) << good.out << good.err;
  EXPECT_TRUE(WasBuilt());
  EXPECT_EQ(ReadFile(tree_ / "trained"),
            "train --preset fetch-reach-fast --seed 3 --print-config\n"
            "train --preset fetch-reach-fast --seed 3 --film\n");
}

TEST_F(RunScript, ProgramsOlderThanASourceRefuseNothingBeforeTheBuild) {
  Built();
  WriteFileAtomically(tree_ / "common" / "new.cpp", "");
  fs::last_write_time(tree_ / "common" / "new.cpp",
                      fs::last_write_time(tree_ / "build/release/bin/shoal") + seconds(2));
  EXPECT_EQ(ExitCode(Train({"--wrong"})), 2);
  EXPECT_TRUE(WasBuilt()) << "what the new source takes is known after the build alone";
}

TEST_F(RunScript, WithoutProgramsPresetsAndFilesThatAreNotThereAreRefused) {
  for (const auto& [arguments, said] :
       std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--preset", "nope"}, "no preset 'nope'"},
           {{"--preset=nope"}, "no preset 'nope'"},
           {{"--config", "/absent.json"}, "cannot read '/absent.json'"}}) {
    const ProgramResult result = Train(arguments);
    EXPECT_EQ(ExitCode(result), 2);
    EXPECT_THAT(result.err, HasSubstr(said));
    EXPECT_FALSE(WasBuilt());
  }
}

TEST_F(RunScript, OnATerminalABuildShowsItsStepsInOneLineAndWhatTheySay) {
  Built();
  Tool("tput", "echo 80");
  setenv("PATH", Path().c_str(), 1);
  TerminalProgram script(tree_ / "run", {"train"});
  EXPECT_EQ(script.End(seconds(30)), 0) << script.shown();
  EXPECT_THAT(script.shown(), HasSubstr("\r\x1b[K[1/2] Building a.cpp\r\na.cpp: a warning\r\n"));
  EXPECT_THAT(script.shown(), Not(HasSubstr("globbed")));
  EXPECT_THAT(script.shown(), Not(HasSubstr("Entering")));
}

}  // namespace
}  // namespace shoal

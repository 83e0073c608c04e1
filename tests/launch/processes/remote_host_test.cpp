// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/remote_host.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/run_files.h"
#include "common/credentials/credentials.h"
#include "launch/processes/process_plan.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

bool Never() { return false; }

// The "other host" is a shell here.
class RemoteHostTest : public ::testing::Test {
 protected:
  RemoteHostTest() {
    host_.name = "far";
    host_.ssh = {"sh", "-c"};
    host_.programs = folder_.path() / "bin";
    host_.run = folder_.path() / "a folder's name";
    MakeFolders(run_ / "made");
    MakeFolders(host_.programs);
    Write(run_ / "config.json", "config");
    WriteClusterAddress(run_, {.domain = 40, .tag = "first", .host = "10.0.0.1", .secure = ""});
  }
  static void Write(const fs::path& file, const std::string& text) {
    WriteFileAtomically(file, text);
  }
  void InstallProgram(const std::string& script) {
    const fs::path program = host_.programs / "shoal-actor";
    Write(program, "#!/bin/sh\n" + script + "\n");
    fs::permissions(program, fs::perms::owner_all);
  }
  template <class Act>
  static std::string Mistake(Act act) {
    try {
      act();
    } catch (const Error& e) {
      return e.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
  const fs::path run_ = folder_.path() / "run";
  RemoteHost host_;
};

TEST(ShellLine, KeepsWordsApartWhateverIsInThem) {
  EXPECT_EQ(ShellLine({"a", "b c", "d'e", "$f"}), R"('a' 'b c' 'd'\''e' '$f')");
}

TEST_F(RemoteHostTest, AHostIsGoodWhenItsProgramHasOurVersion) {
  const std::string release = BuildVersion();
  InstallProgram("echo 'shoal-actor " + release + " (another commit)'");
  CheckHost(host_, Never);
  for (const std::string& other : {std::string("9.9.9"), release + "9"}) {
    const std::string said = "shoal-actor " + other + " (x)";
    InstallProgram("echo '" + said + "'");
    EXPECT_THAT(Mistake([&] { CheckHost(host_, Never); }),
                AllOf(HasSubstr("host far"), HasSubstr("'" + said + "'"), HasSubstr(release)));
  }
}

TEST_F(RemoteHostTest, AHostThatCannotBeReachedIsNamedWithItsLastWord) {
  host_.ssh = {"sh", "-c", "echo Connection refused >&2; exit 255"};
  EXPECT_THAT(Mistake([&] { CheckHost(host_, Never); }),
              AllOf(HasSubstr("host far"), HasSubstr("Connection refused")));
  host_.ssh = {"no-such-ssh"};
  EXPECT_THAT(Mistake([&] { CheckHost(host_, Never); }), HasSubstr("no-such-ssh"));
}

TEST_F(RemoteHostTest, PushesWhatItsActorsNeedAndFetchesWhatTheyLeft) {
  Write(run_ / "made" / "actor-1-5.page", "of another host");
  Write(run_ / "made" / "actor-2-5.page", "earlier");
  const ActorRange actors{.first = 2, .count = 2};
  PushRun(run_, actors, &host_, Never);
  EXPECT_EQ(host_.run, folder_.path() / "a folder's name");
  EXPECT_EQ(ReadFile(host_.run / "config.json"), "config");
  EXPECT_EQ(ReadClusterAddress(host_.run).tag, "first");
  EXPECT_EQ(ReadFile(host_.run / "made" / "actor-2-5.page"), "earlier");
  EXPECT_FALSE(fs::exists(host_.run / "made" / "actor-1-5.page"));

  Write(host_.run / "made" / "actor-2-5.page", "grown");
  Write(host_.run / "made" / "actor-3-6.page", "new");
  Write(host_.run / "made" / "actor-1-7.page", "not theirs");
  fs::create_symlink("/etc/passwd", host_.run / "made" / "actor-3-7.page");
  FetchSequenceLogs(host_, actors, run_, Never);
  EXPECT_EQ(ReadFile(run_ / "made" / "actor-2-5.page"), "grown");
  EXPECT_EQ(ReadFile(run_ / "made" / "actor-3-6.page"), "new");
  EXPECT_FALSE(fs::exists(run_ / "made" / "actor-1-7.page"));
  EXPECT_FALSE(fs::exists(run_ / "made" / "actor-3-7.page"));
}

// A greeting without a line's end, and a line when it is left.
TEST_F(RemoteHostTest, WhatALoginPrintsIsNoAnswer) {
  host_.ssh = {"sh", "-c",
               "echo Welcome; printf 'Today: rain'; sh -c \"$0\"; s=$?; echo Bye; exit $s"};
  InstallProgram("echo 'shoal-actor " + std::string(BuildVersion()) + " (x)'");
  CheckHost(host_, Never);
  const ActorRange actors{.first = 2, .count = 1};
  PushRun(run_, actors, &host_, Never);
  EXPECT_EQ(host_.run, folder_.path() / "a folder's name");
  Write(host_.run / "made" / "actor-2-5.page", std::string("grown\n\0\n", 8));
  FetchSequenceLogs(host_, actors, run_, Never);
  EXPECT_EQ(ReadFile(run_ / "made" / "actor-2-5.page"), std::string("grown\n\0\n", 8));
  // A login shell that discards the output of its command.
  host_.ssh = {"sh", "-c", "sh -c \"$0\" > /dev/null; echo Welcome"};
  EXPECT_THAT(Mistake([&] { FetchSequenceLogs(host_, actors, run_, Never); }),
              AllOf(HasSubstr("host far"), HasSubstr("its output is incomplete")));
}

TEST_F(RemoteHostTest, ASecondPushRenewsTheAddressAndKeepsThePagesThatAreThere) {
  const ActorRange actors{.first = 0, .count = 1};
  PushRun(run_, actors, &host_, Never);
  Write(host_.run / "made" / "actor-0-5.page", "there");
  Write(run_ / "made" / "actor-0-5.page", "older");
  WriteClusterAddress(run_, {.domain = 42, .tag = "second", .host = "10.0.0.1", .secure = ""});
  PushRun(run_, actors, &host_, Never);
  EXPECT_EQ(ReadClusterAddress(host_.run).tag, "second");
  EXPECT_EQ(ReadFile(host_.run / "made" / "actor-0-5.page"), "there");
}

TEST_F(RemoteHostTest, TakesAnActorsCredentialsAlongAndNobodyElses) {
  const fs::path secure = folder_.path() / "secure";
  CreateCredentials(secure, std::vector<RoleRights>{{"actor", {"a"}, {}}, {"learner", {"b"}, {}}},
                    ValidForDays(1));
  WriteClusterAddress(run_, {.domain = 40, .tag = "t", .host = "h", .secure = secure});
  PushRun(run_, {.first = 0, .count = 1}, &host_, Never);
  CheckCredentials(host_.run / "secure", "actor", std::time(nullptr));
  EXPECT_FALSE(fs::exists(host_.run / "secure" / "learner.key"));
  EXPECT_FALSE(fs::exists(host_.run / "secure" / "ca.key"));
  EXPECT_EQ(fs::status(host_.run / "secure" / "actor.key").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_THAT(RemoteActor(host_, 0, run_).command.back(),
              HasSubstr((host_.run / "secure").filename().string()));
}

TEST_F(RemoteHostTest, AFolderThatIsNotThereIsAnErrorThatNamesTheHost) {
  EXPECT_THAT(Mistake([&] { FetchSequenceLogs(host_, {.first = 0, .count = 1}, run_, Never); }),
              AllOf(HasSubstr("host far"), HasSubstr("folder's name")));
}

TEST_F(RemoteHostTest, ItsActorGetsItsNumberAndInterface) {
  MakeFolders(run_ / "logs");
  InstallProgram("echo \"$@\" $OMP_NUM_THREADS");
  host_.interface = "eth7";
  ProcessSpec spec = RemoteActor(host_, 4, run_);
  EXPECT_EQ(spec.Name(), "actor-4");
  EXPECT_TRUE(spec.elsewhere);
  EXPECT_TRUE(spec.holds_input);
  ASSERT_TRUE(RunToEnd(spec, std::chrono::seconds(10), Never)->Clean());
  EXPECT_EQ(LastLine(spec.output),
            "--run " + host_.run.string() + " --id 4 --interface eth7 --stop-with-input 1");
}

TEST(ActorsOf, NumbersFollowThoseOfThisHostAndOfTheHostsBefore) {
  Config config;
  config.actors = 6;
  std::vector<RemoteHost> hosts(2);
  hosts[0].actors = 3;
  hosts[1].actors = 2;
  EXPECT_EQ(ActorsOf(config, hosts, 0).first, 1);
  EXPECT_EQ(ActorsOf(config, hosts, 1).first, 4);
  std::vector<std::string> names;
  for (const ProcessSpec& spec :
       PlanProcesses(TopologyOf(config, hosts), config, "runs/a", hosts)) {
    if (spec.role == "actor") names.push_back(spec.Name() + (spec.elsewhere ? " far" : ""));
  }
  EXPECT_THAT(names, ElementsAre("actor-0", "actor-1 far", "actor-2 far", "actor-3 far",
                                 "actor-4 far", "actor-5 far"));
}

}  // namespace
}  // namespace shoal::launch

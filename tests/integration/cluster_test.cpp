// SPDX-License-Identifier: Apache-2.0
// A run on two hosts: an actor on another host takes part in training despite a lossy network, a
// cut link and the death of its remote shell, and the account of its records stays exact.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "common/dds/domain_xml.h"
#include "tests/support/joined_namespaces.h"
#include "tests/support/processes.h"
#include "tests/support/running_training.h"
#include "tests/support/slow_point.h"

namespace shoal {
namespace {

using nlohmann::json;
using std::chrono::seconds;

constexpr int kFarActor = 1;  // actor 0 runs on the near side

bool Always(const json&) { return true; }

class Cluster : public testing::Test {
 protected:
  void SetUp() override {
    if (!net_.made()) GTEST_SKIP() << "needs root, iproute2 and network namespaces";
  }
  void TearDown() override { unsetenv(dds::kOverrideVariable); }

  // --hosts with one actor here and one on the far side, reached by `ssh`.
  std::vector<std::string> Hosts(const std::vector<std::string>& ssh) const {
    const json hosts{{"schema", "shoal-hosts-1"},
                     {"servers", {{"address", net_.near_address()}, {"actors", 1}}},
                     {"hosts",
                      {{{"name", "far"},
                        {"actors", 1},
                        {"ssh", ssh},
                        {"folder", (run_.parent() / "far").string()}}}}};
    WriteFileAtomically(run_.parent() / "hosts.json", hosts.dump());
    return {"--hosts", (run_.parent() / "hosts.json").string()};
  }
  static TrainingRun::Keys Keys(const std::string& env_steps) {
    return {{"env_steps", env_steps}, {"transport.fragment_bytes", "8000"}};
  }
  RunningTraining Start(const std::vector<std::string>& ssh) const {
    return {run_, run_.Command(Keys("10000000"), Hosts(ssh))};
  }
  // Ends a run in order and expects that every record was stored.
  void EndWithNothingLost(RunningTraining& training) const {
    ASSERT_EQ(kill(training.pid(), SIGINT), 0);
    ASSERT_EQ(training.End(seconds(100)), kInterruptedExit) << training.Output();
    const json meta = run_.Json("meta.json");
    ExpectBalanced(meta);
    for (const char* nothing : {"lost_with_process", "rejected", "after_gap"}) {
      EXPECT_EQ(meta.at("accounting").at(nothing), 0) << training.Output();
    }
    EXPECT_EQ(meta.at("accounting").at("sessions_without_page"), 0);
  }
  // The far actor's next report in which it has made `records` more than in `before`.
  static json WaitForFarRecords(RunningTraining& training, const json& before, double records) {
    return training.reports().WaitFor(
        "actor",
        [&](const json& r) {
          return r.at("pid") == before.at("pid") &&
                 r.value("made", 0.0) >= before.value("made", 0.0) + records;
        },
        seconds(60), kFarActor);
  }
  // Number of records that the far actor reported last.
  double FarRecords() const {
    double made = 0;
    std::ifstream in(run_.path() / "metrics.jsonl");
    for (std::string line; std::getline(in, line);) {
      const json report = json::parse(line);
      if (report.at("role") == "actor" && report.at("id") == kFarActor) made = report.at("made");
    }
    return made;
  }
  // The longest time between two reports of the far actor that were heard.
  double LongestSilence() const {
    std::ifstream in(run_.path() / "metrics.jsonl");
    double longest = 0, last = 0;
    for (std::string line; std::getline(in, line);) {
      const json report = json::parse(line);
      if (report.at("role") != "actor" || report.at("id") != kFarActor) continue;
      const double time = report.at("t");
      if (last > 0) longest = std::max(longest, time - last);
      last = time;
    }
    return longest;
  }
  // Every process of ours drops this share of the datagrams it sends.
  void LoseDatagrams(int per_mille) const {
    std::string xml(dds::BuiltInTemplate());
    const std::string end = "</Internal>";
    xml.insert(xml.find(end),
               fmt::format("<Test><XmitLossiness>{}</XmitLossiness></Test>", per_mille));
    WriteFileAtomically(run_.parent() / "lossy.xml", xml);
    setenv(dds::kOverrideVariable, (run_.parent() / "lossy.xml").c_str(), 1);
  }

  const JoinedNamespaces net_;
  const TrainingRun run_{};
};

TEST_F(Cluster, AnActorOnAnotherHostTrains) {
  const ProgramResult result = run_.Train(Keys("6000"), Hosts(net_.Shell()));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const json meta = run_.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0);
  EXPECT_GT(FarRecords(), 500);
  EXPECT_GT(meta.at("accounting").at("made"), FarRecords());
}

TEST_F(Cluster, OnPolicyTheActorOnAnotherHostPlaysItsHalf) {
  const std::string secure = (run_.parent() / "secure").string();
  const ProgramResult made = RunProgram({"shoal", "secure", "init", secure}, seconds(20));
  ASSERT_EQ(ExitCode(made), 0) << made.err;
  std::vector<std::string> flags = Hosts(net_.Shell());
  flags.insert(flags.end(), {"--secure", secure});
  const ProgramResult result = RunProgram(run_.OnPolicyCommand(Keys("8192"), flags), seconds(180));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const json meta = run_.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0);
  EXPECT_GE(FarRecords(), 4096);
  EXPECT_GE(meta.at("updates"), 8) << "rollouts of 128 steps of eight environments";
}

TEST_F(Cluster, ASecuredRunTrainsOnAnotherHostAndOnlyActorsKeysGoThere) {
  const std::string secure = (run_.parent() / "secure").string();
  const ProgramResult made = RunProgram({"shoal", "secure", "init", secure}, seconds(20));
  ASSERT_EQ(ExitCode(made), 0) << made.err;
  std::vector<std::string> flags = Hosts(net_.Shell());
  flags.insert(flags.end(), {"--secure", secure});
  const ProgramResult result = run_.Train(Keys("4000"), flags);
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const json meta = run_.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0);
  EXPECT_EQ(meta.at("accounting").at("sessions_without_page"), 0);
  int keys = 0;
  for (const auto& file : std::filesystem::recursive_directory_iterator(run_.parent() / "far")) {
    if (file.path().extension() != ".key") continue;
    EXPECT_EQ(file.path().filename(), "actor.key");
    ++keys;
  }
  EXPECT_EQ(keys, 1);
}

TEST_F(Cluster, CatchesUpAfterSevenSecondsWithoutALinkThatLosesDatagrams) {
  LoseDatagrams(50);
  RunningTraining training = Start(net_.Shell());
  const json first = training.reports().WaitFor("actor", Always, seconds(60), kFarActor);
  ASSERT_FALSE(first.is_null()) << training.Output();
  ASSERT_FALSE(WaitForFarRecords(training, first, 500).is_null()) << training.Output();

  ASSERT_TRUE(net_.Cut());
  std::this_thread::sleep_for(seconds(7));  // longer than the transport's lease
  ASSERT_TRUE(net_.Join());

  const json before = training.reports().Await("actor", kFarActor);
  EXPECT_FALSE(WaitForFarRecords(training, before, 500).is_null()) << "the same process goes on\n"
                                                                   << training.Output();
  EXPECT_GT(LongestSilence(), 6) << "the link was not cut";
  EndWithNothingLost(training);
}

TEST_F(Cluster, AnActorWhoseRemoteShellDiedLeavesAndAnotherTakesItsPlace) {
  // Like ssh: a client here between us and the program there.
  std::vector<std::string> relay{"sh", "-c", "exec 3<&0; ", "relay"};
  for (const std::string& word : net_.Shell()) relay[2] += word + " ";
  relay[2] += "\"$1\" <&3 3<&- & wait $!";
  RunningTraining training = Start(relay);
  const json first = training.reports().WaitFor("actor", Always, seconds(60), kFarActor);
  ASSERT_FALSE(first.is_null()) << training.Output();
  const auto actor = first.at("pid").get<pid_t>();
  pid_t client = actor;
  while (client != 0 && ParentOf(client) != training.pid()) client = ParentOf(client);
  ASSERT_NE(client, 0);
  ASSERT_NE(client, actor);

  ASSERT_EQ(kill(client, SIGKILL), 0);
  EXPECT_TRUE(WaitUntilEnded(actor, seconds(30)));
  const json successor = training.reports().WaitFor(
      "actor", [&](const json& r) { return r.at("pid") != actor; }, seconds(60), kFarActor);
  ASSERT_FALSE(successor.is_null()) << training.Output();
  EXPECT_FALSE(WaitForFarRecords(training, successor, 200).is_null());
  EndWithNothingLost(training);
}

// Its shell still answers: each new actor there starts and finds no way to the coordinator.
TEST_F(Cluster, AHostThatIsCutOffIsTriedOnWhileTheOthersTrain) {
  RunningTraining training(run_, run_.Command(SlowPoint(Keys("10000000")), Hosts(net_.Shell())));
  const json first = training.reports().WaitFor("actor", Always, seconds(60), kFarActor);
  ASSERT_FALSE(first.is_null()) << training.Output();
  ASSERT_TRUE(net_.Cut());
  const json tried = training.reports().WaitFor(
      "coordinator", [](const json& r) { return r.value("restarts", 0.0) >= 3; }, seconds(150));
  ASSERT_FALSE(tried.is_null()) << training.Output();
  EXPECT_EQ(tried.value("actors_working", 0.0), 1);
  ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
  EXPECT_TRUE(training.WaitForOutput("actors 1 of 2: actor-1: exit code 1: ")) << training.Output();

  ASSERT_TRUE(net_.Join());
  const json successor = training.reports().WaitFor(
      "actor", [&](const json& r) { return r.at("pid") != first.at("pid"); }, seconds(90),
      kFarActor);
  ASSERT_FALSE(successor.is_null()) << training.Output();
  EXPECT_FALSE(WaitForFarRecords(training, successor, 200).is_null());
  ASSERT_EQ(kill(training.pid(), SIGINT), 0);
  ASSERT_EQ(training.End(seconds(100)), kInterruptedExit) << training.Output();
  ExpectBalanced(run_.Json("meta.json"));
}

TEST_F(Cluster, AHostThatCannotRunActorsIsNamedBeforeTheRunBegins) {
  const ProgramResult result =
      run_.Train(Keys("6000"), Hosts({"sh", "-c", "echo no route to host >&2; exit 255"}));
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_NE(result.err.find("host far"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("no route to host"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(run_.path()));
}

}  // namespace
}  // namespace shoal

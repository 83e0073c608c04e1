// SPDX-License-Identifier: Apache-2.0
// Batches from the real replay to the real learner use shared memory on one host. If that is
// impossible they use the network, which is reported. The death of either process leaves no memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <set>

#include "common/wire/batch_slots.h"
#include "tests/support/isolation.h"
#include "tests/support/paths.h"
#include "tests/support/processes.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::Not;

// Runs from pixels whose batches have 5 MB.
TrainingRun::Keys Keys(const TrainingRun::Keys& more = {}) {
  TrainingRun::Keys keys = TrainingRun::FromPixels({{"env_steps", "600"},
                                                    {"actors", "1"},
                                                    {"eval.final_episodes", "0"},
                                                    {"eval.interval", "1000000"},
                                                    {"learner.batch", "64"},
                                                    {"replay.storage", "memory"}});
  for (const auto& [key, value] : more) keys[key] = value;
  return keys;
}

std::string Log(const TrainingRun& run, const std::string& process) {
  return ReadFile(run.path() / "logs" / (process + ".log"));
}

// The inodes of slots that a process has open or mapped.
std::set<std::string> SlotsOf(pid_t pid) {
  std::set<std::string> inodes;
  std::ifstream maps("/proc/" + std::to_string(pid) + "/maps");
  for (std::string line; std::getline(maps, line);) {
    std::istringstream words(line);
    std::string range, rights, offset, device, inode, name;
    words >> range >> rights >> offset >> device >> inode >> name;
    if (name.find("memfd:shoal-batches") != std::string::npos) inodes.insert(inode);
  }
  return inodes;
}

pid_t PidOf(RunningTraining* training, const std::string& role) {
  return training->reports().Await(role).at("pid").get<pid_t>();
}

TEST(SharedBatches, ATrainingOnOneHostUsesThem) {
  const TrainingRun run;
  const ProgramResult result = run.Train(Keys());
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  ExpectBalanced(run.Json("meta.json"));
  ReportReader reports(run.path());
  const json learner = reports.Last("learner"), replay = reports.Last("replay");
  EXPECT_EQ(learner.at("batches_shared"), 1);
  EXPECT_GT(learner.at("updates").get<double>(), 0);
  EXPECT_EQ(learner.at("refused_slots"), 0);
  EXPECT_EQ(replay.at("slot_batches").get<double>(), replay.at("sampled").get<double>() / 64);
  EXPECT_LE(replay.at("slots_held"), 4);
  EXPECT_THAT(Log(run, "replay-0"), HasSubstr("batches go through shared memory: 4 slots, 22 MB"));
  EXPECT_THAT(Log(run, "learner-0"), HasSubstr("batches come through shared memory"));
}

TEST(SharedBatches, WhereTheyDoNotFitTheNetworkIsUsedAndItIsSaid) {
  struct rlimit small {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &small), 0);
  small.rlim_cur = 16'000'000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const TrainingRun run;
  const ProgramResult result = run.Train(Keys());
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  ExpectBalanced(run.Json("meta.json"));
  ReportReader reports(run.path());
  EXPECT_EQ(reports.Last("learner").at("batches_shared"), 0);
  EXPECT_EQ(reports.Last("replay").at("slot_batches"), 0);
  EXPECT_GT(reports.Last("replay").at("sampled").get<double>(), 0);
  EXPECT_THAT(Log(run, "replay-0"), HasSubstr("batches go over the network: shared memory of"));
  EXPECT_THAT(Log(run, "replay-0"), HasSubstr("ulimit -f"));
  EXPECT_THAT(Log(run, "learner-0"), HasSubstr("batches come over the network"));
}

// Imitates another host: in the learner's own pid namespace, the replay's pid belongs to no process
// or to another one.
TEST(SharedBatches, ALearnerThatCannotOpenThemGetsItsBatchesOverTheNetwork) {
  const std::string apart = std::string("/usr/bin/unshare --pid --fork --kill-child --mount-proc") +
                            (geteuid() == 0 ? "" : " --user --map-root-user");
  if (ExitCode(RunCommand({"/bin/sh", "-c", apart + " /bin/true"}, seconds(20))) != 0) {
    GTEST_SKIP() << "unshare: no process numbers of one's own";
  }
  const TrainingRun run;
  const fs::path bin = run.parent() / "bin";
  fs::create_directory(bin);
  for (const char* program : {"shoal", "shoal-actor", "shoal-replay"}) {
    fs::copy_file(ProgramPath(program), bin / program);
  }
  fs::copy(SourcePath("launch/data/presets"), bin / "presets");
  std::ofstream(bin / "shoal-learner")
      << "#!/bin/sh\nexec " << apart << " " << ProgramPath("shoal-learner") << " \"$@\"\n";
  fs::permissions(bin / "shoal-learner", fs::perms::owner_all);
  std::vector<std::string> command = run.Command(Keys());
  command[0] = (bin / "shoal").string();
  const ProgramResult result = RunCommand(command, seconds(180));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  ExpectBalanced(run.Json("meta.json"));
  ReportReader reports(run.path());
  EXPECT_EQ(reports.Last("learner").at("batches_shared"), 0);
  EXPECT_GT(reports.Last("learner").at("refused_slots").get<double>(), 0);
  EXPECT_GT(reports.Last("learner").at("updates").get<double>(), 0);
  EXPECT_THAT(Log(run, "learner-0"), HasSubstr("asking for batches over the network"));
  EXPECT_THAT(Log(run, "replay-0"), HasSubstr("cannot open the shared memory"));
}

// The slots of a killed process are freed at its death, or with the next batch if the other process
// still maps them. Both processes return to shared memory, and no batch and no record is lost.
TEST(SharedBatches, DeathsOfReplayAndLearnerLeaveNoneBehind) {
  const TrainingRun run;
  RunningTraining training(run, run.Command(Keys({{"env_steps", "1000000"},
                                                  {"replay.storage", "file"},
                                                  {"learner.checkpoint_period", "20"}})));
  ASSERT_TRUE(training.WaitForMoreSteps(150)) << training.Output();
  for (const char* role : {"replay", "learner", "replay", "learner"}) {
    const std::set<std::string> before = SlotsOf(PidOf(&training, "replay"));
    ASSERT_EQ(before.size(), 1u) << role << ": " << training.Output();
    ASSERT_NO_FATAL_FAILURE(KillAndWaitForSuccessor(&training, role));
    const double updates = training.reports().Last("learner").at("updates").get<double>();
    const json learner = training.reports().WaitFor("learner", [&](const json& r) {
      return r.contains("batches_shared") && r.at("updates").get<double>() > updates + 3;
    });
    ASSERT_FALSE(learner.is_null()) << role << ": " << training.Output();
    EXPECT_EQ(learner.at("batches_shared"), 1) << role;
    const std::set<std::string> after = SlotsOf(PidOf(&training, "replay"));
    EXPECT_EQ(after.size(), 1u) << role;
    EXPECT_NE(after, before) << role;
    EXPECT_EQ(SlotsOf(learner.at("pid").get<pid_t>()), after) << role;
  }
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(120)), kInterruptedExit) << training.Output();
  const json meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("accounting").at("lost_with_replay"), 0);
  EXPECT_EQ(meta.at("accounting").at("lost_with_process"), 0);
  EXPECT_THAT(Log(run, "learner-0"), Not(HasSubstr("over the network")));
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// Files of a run that are removed, damaged, replaced or cannot be written, and the room they take.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/support/isolation.h"
#include "tests/support/running_training.h"
#include "tests/support/slow_point.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

#define SHOAL_NEEDS(expression) \
  if (const std::string& no = (expression); !no.empty()) GTEST_SKIP() << no

std::vector<std::string> ResumeCommand(const TrainingRun& run, const std::string& env_steps) {
  return {"shoal", "train", "--resume", run.path(), "--set", "env_steps=" + env_steps};
}

ProgramResult Resume(const TrainingRun& run, const std::string& env_steps) {
  return RunProgram(ResumeCommand(run, env_steps), seconds(180));
}

// Env steps of the evaluations, by their files' names.
std::vector<int64_t> EvaluatedSteps(const TrainingRun& run) {
  std::vector<int64_t> steps;
  for (const auto& entry : fs::directory_iterator(run.path() / "eval")) {
    const auto file = nlohmann::json::parse(ReadFile(entry.path()));
    if (entry.path().filename() != "final.json") steps.push_back(file.at("env_steps"));
  }
  std::ranges::sort(steps);
  return steps;
}

TEST(RunFiles, AFinishedRunKeepsItsReplayOnlyWhereItIsAskedTo) {
  const TrainingRun run;
  const ProgramResult first =
      run.Train({{"env_steps", "1500"}, {"eval.final_episodes", "0"}, {"actors", "1"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  EXPECT_FALSE(fs::exists(run.path() / "replay.ring"));
  EXPECT_THAT(first.out, HasSubstr("replay.ring removed: 13 MB free again (replay.keep = true"));
  const std::string output = (run.parent() / "x" / "main_data.hdf5").string();
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"shoal", "replay", "peek", "--run", run.path()},
        std::vector<std::string>{"shoal", "replay", "export", run.path(), "--output", output}}) {
    const ProgramResult result = RunProgram(command, seconds(60));
    EXPECT_EQ(ExitCode(result), 2) << result.out;
    EXPECT_THAT(result.err, HasSubstr("--set replay.keep=true"));
  }
  const ProgramResult further = RunProgram({"shoal", "train", "--resume", run.path(), "--set",
                                            "env_steps=2500", "--set", "replay.keep=true"},
                                           seconds(180));
  ASSERT_EQ(ExitCode(further), 0) << further.out << further.err;
  EXPECT_TRUE(fs::exists(run.path() / "replay.ring"));
  ExpectBalanced(run.Json("meta.json"));
}

TEST(RunFiles, CleanFreesReplaysAfterAskingAndNeverThoseOfALivingRun) {
  const TrainingRun run;
  const auto clean = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"shoal", "clean", "--run-dir", run.parent()});
    return RunProgram(options, seconds(30));
  };
  const fs::path ring = run.path() / "replay.ring";
  {
    RunningTraining training(run, run.Command({{"env_steps", "1000000"}, {"actors", "1"}}));
    ASSERT_TRUE(training.WaitForSteps(1000)) << training.Output();
    EXPECT_THAT(clean({"--yes"}).out, HasSubstr("nothing to remove"));
    const ProgramResult living = clean({"--yes", "run"});
    EXPECT_EQ(ExitCode(living), 2);
    EXPECT_THAT(living.err, HasSubstr("is running: nothing is removed"));
    training.Interrupt();
    ASSERT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  }
  ASSERT_TRUE(fs::exists(ring)) << "an interrupted run goes on with it";
  EXPECT_THAT(clean({"--yes"}).out, HasSubstr("nothing to remove"));
  const ProgramResult unasked = clean({"run"});
  EXPECT_EQ(ExitCode(unasked), 2) << "no terminal to ask at";
  EXPECT_THAT(unasked.err, HasSubstr("--yes"));
  ASSERT_TRUE(fs::exists(ring));
  const ProgramResult cleaned = clean({"--yes", "run"});
  EXPECT_EQ(ExitCode(cleaned), 0) << cleaned.err;
  EXPECT_THAT(cleaned.out, AllOf(HasSubstr(ring.string() + "  13 MB  of a run that is interrupted"),
                                 HasSubstr("13 MB freed")));
  EXPECT_FALSE(fs::exists(ring));
  EXPECT_THAT(RunProgram({"shoal", "runs", "--run-dir", run.parent()}, seconds(30)).out,
              HasSubstr("SIZE"));
}

// Permissions follow the umask, except where the run is secured.
TEST(RunFiles, OthersMayReadARunThatIsNotSecured) {
  const TrainingRun run;
  umask(022);
  const ProgramResult first =
      run.Train({{"env_steps", "1500"}, {"actors", "1"}, {"replay.keep", "true"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  for (const char* name : {"", "tensorboard", "checkpoints", "eval/final.json", "meta.json",
                           "metrics.jsonl", "replay.ring", "logs/learner-0.log"}) {
    EXPECT_EQ(fs::status(run.path() / name).permissions() & fs::perms::others_read,
              fs::perms::others_read)
        << name;
    EXPECT_EQ(fs::status(run.path() / name).permissions() & fs::perms::others_write,
              fs::perms::none)
        << name;
  }
  const fs::path secure = run.parent() / "secure";
  ASSERT_EQ(ExitCode(RunProgram({"shoal", "secure", "init", secure}, seconds(60))), 0);
  const TrainingRun secured;
  const ProgramResult second = secured.Train(
      {{"env_steps", "1200"}, {"actors", "1"}, {"eval.final_episodes", "0"}}, {"--secure", secure});
  ASSERT_EQ(ExitCode(second), 0) << second.out << second.err;
  EXPECT_EQ(fs::status(secured.path()).permissions(), fs::perms::owner_all);
  for (const auto& entry : fs::recursive_directory_iterator(secured.path())) {
    EXPECT_EQ(entry.status().permissions() & (fs::perms::group_all | fs::perms::others_all),
              fs::perms::none)
        << entry.path();
  }
}

// Damages each small file of a run in turn: the run continues, or names a remedy at once.
TEST(RunFiles, DamagedFilesNeverCostFiveRestarts) {
  const TrainingRun run;
  const ProgramResult first = run.Train({{"env_steps", "1500"},
                                         {"actors", "1"},
                                         {"eval.final_episodes", "0"},
                                         {"replay.keep", "true"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  int env_steps = 1500;
  const auto damage_and_resume = [&](const std::string& name) {
    const fs::path file = run.path() / name;
    fs::resize_file(file, fs::file_size(file) / 2);
    const ProgramResult resumed = Resume(run, std::to_string(env_steps += 300));
    EXPECT_EQ(resumed.out.find("restart in"), std::string::npos) << name << resumed.out;
    return resumed;
  };
  std::vector<std::string> rebuilt{"learner.page", "accounting.json", "sessions/learner-0",
                                   "sessions/replay-0", "sessions/actor-0"};
  for (const auto& entry : fs::directory_iterator(run.path() / "made")) {
    if (entry.path().extension() == ".page")
      rebuilt.push_back("made/" + entry.path().filename().string());
  }
  ASSERT_GE(rebuilt.size(), 6u);
  for (const std::string& name : rebuilt) {
    const ProgramResult resumed = damage_and_resume(name);
    EXPECT_EQ(ExitCode(resumed), 0) << name << resumed.out << resumed.err;
    EXPECT_THAT(resumed.out, HasSubstr(name + "' is damaged: re"));
    ExpectBalanced(run.Json("meta.json"));
    EXPECT_GE(run.Json("meta.json").at("env_steps"), env_steps);
  }
  const std::string meta = ReadFile(run.path() / "meta.json");
  for (const std::string name : {"meta.json", "replay.ring"}) {
    const ProgramResult refused = damage_and_resume(name);
    EXPECT_EQ(ExitCode(refused), 2) << name << refused.out << refused.err;
    EXPECT_THAT(refused.err, AllOf(HasSubstr(name), HasSubstr("remove it, and the run goes on")));
    if (name == "meta.json") WriteFileAtomically(run.path() / name, meta);
  }
  // A slot in the middle is found by the replay itself, which is not started five times for it.
  ASSERT_TRUE(fs::remove(run.path() / "replay.ring"));
  ASSERT_EQ(ExitCode(Resume(run, std::to_string(env_steps += 1500))), 0);
  std::fstream ring(run.path() / "replay.ring", std::ios::in | std::ios::out | std::ios::binary);
  ring.seekp(600'000 + 100 * 256);
  ring.write(std::string(300, 'x').data(), 300);
  ring.close();
  const ProgramResult refused = Resume(run, std::to_string(env_steps += 300));
  EXPECT_EQ(ExitCode(refused), 1) << refused.out << refused.err;
  EXPECT_THAT(refused.out,
              AllOf(HasSubstr("replay-0: exit code 2"), HasSubstr("remove it, and the run goes on"),
                    Not(HasSubstr("restart in"))));
}

TEST(RunFiles, AFifoInPlaceOfAFileIsRefusedAtOnce) {
  const TrainingRun run;
  const ProgramResult first =
      run.Train({{"env_steps", "1500"}, {"actors", "1"}, {"eval.final_episodes", "0"}});
  ASSERT_EQ(ExitCode(first), 0) << first.out << first.err;
  for (const char* name : {"config.json", "meta.json", "metrics.jsonl", "learner.page",
                           "cluster.json", ".lock", "logs/learner-0.log"}) {
    const fs::path file = run.path() / name, kept = run.path() / "kept";
    fs::rename(file, kept);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
    const ProgramResult refused = RunProgram(
        {"shoal", "train", "--resume", run.path(), "--set", "env_steps=2000"}, seconds(20));
    EXPECT_TRUE(refused.ended) << name << ": it waits";
    EXPECT_THAT(ExitCode(refused), ::testing::AnyOf(1, 2)) << name << refused.out;
    EXPECT_THAT(refused.err, HasSubstr(name == std::string("config.json") ? "no run" : name));
    EXPECT_TRUE(RunProgram({"shoal", "runs", "--run-dir", run.parent()}, seconds(20)).ended);
    fs::remove(file);
    fs::rename(kept, file);
  }
}

// Fills the free space of a disk until destruction.
class Filler {
 public:
  explicit Filler(const fs::path& file) : file_(file) {
    std::ofstream out(file, std::ios::binary);
    const std::string block(4096, 'x');
    while (out.write(block.data(), std::streamsize(block.size())).flush()) {
    }
  }
  ~Filler() { Remove(); }
  void Remove() { fs::remove(file_); }

 private:
  const fs::path file_;
};

int Occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// A small disk for a run; only its output is written elsewhere.
class RunOnASmallDisk {
 public:
  RunOnASmallDisk() : disk_(run.parent(), "64m") {
    fs::create_symlink(elsewhere_.path() / "output", run.parent() / "output");
  }
  const std::string& why_not() const { return disk_.why_not(); }

  const TrainingRun run;

 private:
  const TemporaryFolder elsewhere_;
  const SmallDisk disk_;
};

TEST(RunFiles, AFullDiskIsSaidOnceAndTrainingGoesOnUntilThereIsRoom) {
  SHOAL_NEEDS(OwnMounts());
  const RunOnASmallDisk disk;
  SHOAL_NEEDS(disk.why_not());
  const TrainingRun& run = disk.run;
  RunningTraining training(run, run.Command(SlowPoint({{"env_steps", "1000000"},
                                                       {"actors", "1"},
                                                       {"replay.capacity", "5000"},
                                                       {"eval.interval", "1000"},
                                                       {"eval.final_episodes", "0"},
                                                       {"learner.checkpoint_period", "200"}})));
  ASSERT_TRUE(training.WaitForSteps(1500)) << training.Output();
  const auto stored = [&] {
    return training.reports().Await("replay").at("stored_steps").get<int64_t>();
  };
  const int64_t full = stored();
  Filler filler(run.parent() / "filler");
  // Reports are in metrics.jsonl, which is full as well: only time tells.
  std::this_thread::sleep_for(seconds(15));
  filler.Remove();
  std::this_thread::sleep_for(seconds(2));  // kept lines are written with the next one
  const int64_t room = stored();
  ASSERT_TRUE(training.WaitForMoreSteps(700)) << training.Output();
  std::this_thread::sleep_for(seconds(11));  // a checkpoint is tried again every ten
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  const std::string out = training.Output();
  EXPECT_EQ(Occurrences(out, "meta.json: cannot write"), 1) << out;
  EXPECT_EQ(Occurrences(out, "meta.json: written again"), 1) << out;
  EXPECT_EQ(Occurrences(out, "cannot write its checkpoints"), 1) << out;
  EXPECT_EQ(Occurrences(out, "has written its checkpoints"), 1) << out;
  const auto meta = run.Json("meta.json");
  ExpectBalanced(meta);
  EXPECT_EQ(meta.at("restarts"), 0);
  EXPECT_EQ(meta.at("updates_lost"), 0);
  const std::vector<int64_t> evaluated = EvaluatedSteps(run);
  EXPECT_TRUE(std::ranges::any_of(evaluated, [&](int64_t at) { return at > full && at < room; }))
      << "those of the time between " << full << " and " << room << " env steps are there";
}

TEST(RunFiles, ARunWhoseFolderIsMovedGoesOnAndSaysWhatItCouldNotWrite) {
  const TrainingRun run;
  RunningTraining training(run, run.Command({{"env_steps", "1000000"},
                                             {"actors", "1"},
                                             {"eval.final_episodes", "0"},
                                             {"learner.checkpoint_period", "200"}}));
  ASSERT_TRUE(training.WaitForSteps(1500)) << training.Output();
  const fs::path elsewhere = run.parent() / "moved";
  fs::rename(run.path(), elsewhere);
  std::this_thread::sleep_for(seconds(5));
  EXPECT_THAT(training.Output(), Not(HasSubstr("restart in")));
  fs::rename(elsewhere, run.path());
  ASSERT_TRUE(training.WaitForMoreSteps(500)) << training.Output();
  training.Interrupt();
  ASSERT_EQ(training.End(seconds(60)), kInterruptedExit) << training.Output();
  EXPECT_THAT(training.Output(),
              AllOf(HasSubstr("meta.json: "), HasSubstr("meta.json: written again")));
  ExpectBalanced(run.Json("meta.json"));
}

}  // namespace
}  // namespace shoal

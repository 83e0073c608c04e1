// SPDX-License-Identifier: Apache-2.0
// Faults of the machine: no space, no permission, no port, little memory. Each gets one clear line,
// and complete files stay complete.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/isolation.h"
#include "tests/support/paths.h"
#include "tests/support/running_training.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string kPresets = SourcePath("launch/data/presets");

#define SHOAL_NEEDS(expression) \
  if (const std::string& no = (expression); !no.empty()) GTEST_SKIP() << no

// The only line on stderr.
void ExpectOneErrorLine(const ProgramResult& result, const auto& matcher) {
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_THAT(result.err, matcher);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
}

TEST(Surroundings, ARingThatDoesNotFitTheDiskIsRefusedWithBothSizes) {
  SHOAL_NEEDS(OwnMounts());
  const TrainingRun run;
  const SmallDisk disk(run.parent(), "8m");
  SHOAL_NEEDS(disk.why_not());
  ExpectOneErrorLine(run.Train({}, {}, seconds(60)),
                     AllOf(HasSubstr("the replay file needs 13 MB"), HasSubstr("are free in"),
                           HasSubstr("replay.capacity")));
  EXPECT_FALSE(fs::exists(run.path())) << "nothing half-written";
}

// `shoal` as an unprivileged user, because permissions do not bind root. Runs a copy of the program
// and the presets: that user may not read root's checkout.
ProgramResult RunAsCommonUser(const fs::path& folder, std::vector<std::string> words) {
  fs::permissions(folder, fs::perms::all);
  fs::create_directory(folder / "bin");
  for (const char* program : {"shoal", "shoal-actor", "shoal-replay", "shoal-learner"}) {
    fs::copy_file(ProgramPath(program), folder / "bin" / program);
  }
  fs::copy(kPresets, folder / "bin" / "presets");
  words.insert(words.begin(), (folder / "bin" / "shoal").string());
  if (geteuid() == 0) {
    words.insert(words.begin(),
                 {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
  }
  return RunCommand(std::move(words), seconds(60), {{"TMPDIR", folder.string()}});
}

TEST(Surroundings, AFolderThatMayNotBeWrittenIsNamed) {
  const TemporaryFolder folder;
  const fs::path locked = folder.path() / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                              fs::perms::others_exec);
  ExpectOneErrorLine(RunAsCommonUser(folder.path(), {"train", "--preset", "fetch-reach-state",
                                                     "--set", "run_dir=" + locked.string()}),
                     AllOf(HasSubstr("cannot create folder"), HasSubstr(locked.string()),
                           HasSubstr("Permission denied")));
}

TEST(Surroundings, WithoutAnyPresetTheFoldersAreNamed) {
  SHOAL_NEEDS(OwnMounts());
  const SmallDisk disk(kPresets, "1m");
  SHOAL_NEEDS(disk.why_not());
  ExpectOneErrorLine(RunProgram({"shoal", "train", "--preset", "fetch-reach-state"}, seconds(60)),
                     AllOf(HasSubstr("found no presets"), HasSubstr("bin/presets (No such file"),
                           HasSubstr("share/shoal/presets (holds none)")));
}

TEST(Surroundings, AReadOnlyDiskIsNamed) {
  SHOAL_NEEDS(OwnMounts());
  const TrainingRun run;
  const SmallDisk disk(run.parent(), "1m", MS_RDONLY);
  SHOAL_NEEDS(disk.why_not());
  ExpectOneErrorLine(run.Train({}, {}, seconds(60)),
                     AllOf(HasSubstr(run.path().string()), HasSubstr("Read-only file system")));
}

TEST(Surroundings, WhenEveryDomainIsTakenThePortsAreNamed) {
  SHOAL_NEEDS(OwnNetwork());
  std::vector<int> sockets;
  for (int port = 7400; port < 33000; ++port) {
    const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    // One port per domain is enough: discovery ports lie 250 apart.
    if ((port - 7400) % 250 == 10) {
      ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address), 0) << port;
      sockets.push_back(fd);
    } else {
      close(fd);
    }
  }
  const TrainingRun run;
  ExpectOneErrorLine(
      run.Train({}, {}, seconds(60)),
      AllOf(HasSubstr("DDS domains from 2 to 98 are taken"), HasSubstr("UDP ports")));
  EXPECT_FALSE(fs::exists(run.path())) << "nothing half-written";
  for (const int fd : sockets) close(fd);
}

TEST(Surroundings, TrainingNeedsNoSharedMemory) {
  SHOAL_NEEDS(OwnMounts());
  const SmallDisk disk("/dev/shm", "4k", MS_RDONLY);
  SHOAL_NEEDS(disk.why_not());
  const TrainingRun run;
  const ProgramResult result =
      run.Train({{"env_steps", "2000"}, {"actors", "1"}, {"eval.final_episodes", "0"}});
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  ExpectBalanced(run.Json("meta.json"));
  // The shared memory of batches is not a file in /dev/shm.
  EXPECT_EQ(ReportReader(run.path()).Last("learner").at("batches_shared"), 1);
}

TEST(Surroundings, AReplayBeyondTheMemoryLimitIsRefusedNamingTheLimit) {
  const MemoryLimit limit(400'000'000);
  SHOAL_NEEDS(limit.why_not());
  const TrainingRun run;
  ExpectOneErrorLine(
      run.Train({{"replay.storage", "memory"}, {"replay.capacity", "5000000"}}, {}, seconds(60)),
      AllOf(HasSubstr("MB of memory"), HasSubstr(limit.group().string()),
            HasSubstr("replay.capacity")));
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// A stopped soak or benchmark leaves no processes and files.
#include <gtest/gtest.h>

#include <csignal>
#include <thread>

#include "common/base/clock.h"
#include "common/base/files.h"
#include "launch/processes/child_process.h"
#include "tests/support/paths.h"
#include "tests/support/processes.h"
#include "tests/support/temporary_folder.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

// A file of that name somewhere in the folder, within a minute.
bool WaitForFile(const fs::path& folder, const std::string& name) {
  const SteadyTime end = Now() + seconds(60);
  while (Now() < end) {
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, error), last; !error && it != last;
         it.increment(error)) {
      if (it->path().filename() == name) return true;
    }
    std::this_thread::sleep_for(milliseconds(20));
  }
  return false;
}

// Starts the program and tells it to stop when it has written `begun`.
void ExpectNothingIsLeft(const std::vector<std::string>& command, const std::string& begun) {
  const TemporaryFolder temporary;
  const fs::path files = temporary.path() / "files", output = temporary.path() / "output";
  MakeFolders(files);
  launch::ProcessSpec spec;
  spec.role = "test";
  spec.command = command;
  spec.command[0] = ProgramPath(command[0]);
  spec.environment = {{"TMPDIR", files.string()}};
  spec.output = output;
  launch::ChildProcess program(spec);
  ASSERT_TRUE(WaitForFile(files, begun)) << ReadFile(output);
  program.Signal(SIGTERM);
  ASSERT_TRUE(WaitUntilEnded(program.pid(), seconds(60))) << ReadFile(output);
  const auto status = program.Poll();
  ASSERT_TRUE(status);
  EXPECT_EQ(status->Describe(), "killed by SIGTERM");
  EXPECT_TRUE(fs::is_empty(files)) << fs::directory_iterator(files)->path();
  EXPECT_NE(ReadFile(output).find("interrupted"), std::string::npos) << ReadFile(output);
}

TEST(Interrupted, ASoakTakesItsRunAndItsFilesWithIt) {
  ExpectNothingIsLeft({"shoal-soak", "--faults", "100"}, "meta.json");
}

TEST(Interrupted, ABenchmarkTakesItsProcessesAndItsFilesWithIt) {
  ExpectNothingIsLeft({"shoal-bench-actors", "--actors", "2", "--seconds", "500"},
                      "accounting.json");
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// `shoal check` as a user runs it.
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "common/base/clock.h"
#include "tests/support/program.h"
#include "tests/support/roomy_folder.h"

namespace shoal {
namespace {

TEST(Check, AMachineThatBuildsShoalCanTrain) {
  const TemporaryFolder folder("shoal-", RoomyFolder());
  const std::string json = (folder.path() / "check.json").string();
  WriteFileAtomically(json, "an older one");
  const ProgramResult result =
      RunProgram({"shoal", "check", "--run-dir", folder.path().string(), "--json", json},
                 std::chrono::seconds(60));
  ASSERT_EQ(ExitCode(result), 0) << result.out << result.err;
  const auto report = nlohmann::json::parse(ReadFile(json));
  EXPECT_EQ(report.at("schema"), "shoal-check-1");
  EXPECT_NE(report.at("verdict"), "FAIL");
  std::vector<std::string> names;
  for (const auto& check : report.at("checks")) {
    names.push_back(check.at("name"));
    EXPECT_NE(check.at("finding"), "") << names.back();
    EXPECT_EQ(check.at("verdict") == "OK", check.at("advice") == "") << names.back();
  }
  EXPECT_EQ(names, (std::vector<std::string>{"system", "cpu", "cores", "gpu", "preset", "rendering",
                                             "opengl", "physics", "dds loopback", "disk", "memory",
                                             "shared memory", "training"}));
  int left = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    ++left;
  }
  EXPECT_EQ(left, 1) << "the report alone";
}

// A folder that takes no runs: the kernel refuses writes there, even by root.
TEST(Check, AFolderThatTakesNoRunsFailsTheLinesThatNeedIt) {
  const ProgramResult result =
      RunProgram({"shoal", "check", "--run-dir", "/proc/sys"}, std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(result), 1) << result.out << result.err;
  EXPECT_NE(result.out.find("FAIL  disk"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("FAIL  training"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("/proc/sys"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("OK    rendering"), std::string::npos) << "the others are looked at";
}

TEST(Check, AnInterruptionEndsItAfterTheLineThatItIsAt) {
  const TemporaryFolder folder;
  launch::ProcessSpec spec;
  spec.command = {ProgramPath("shoal"), "check", "--run-dir", folder.path().string()};
  spec.output = folder.path() / "out";
  launch::ChildProcess check(spec);
  const auto said = [&] {
    return std::filesystem::exists(spec.output) ? ReadFile(spec.output) : "";
  };
  const SteadyTime end = Now() + std::chrono::seconds(30);
  while (Now() < end && said().find("preset") == std::string::npos) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  check.Signal(SIGINT);
  std::optional<launch::ExitStatus> status;
  while (Now() < end && !(status = check.Poll())) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ASSERT_TRUE(status);
  EXPECT_EQ(status->Describe(), "killed by SIGINT");
  EXPECT_NE(said().find("\ninterrupted\n"), std::string::npos) << said();
  EXPECT_EQ(said().find("training"), std::string::npos) << said();
}

}  // namespace
}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
#include "launch/record/metrics_log.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

MetricsMessage Report(double time, double value = 1) {
  MetricsMessage message;
  message.role = "actor";
  message.id = 3;
  message.pid = 77;
  message.state = "running";
  message.time = time;
  message.names = {"env_steps"};
  message.values = {value};
  return message;
}

std::vector<nlohmann::json> Lines(const std::filesystem::path& file) {
  std::istringstream in(ReadFile(file));
  std::vector<nlohmann::json> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
  return lines;
}

TEST(MetricsLog, WritesOneObjectPerLineAndAppends) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  for (const MetricsMessage& report : {Report(1, 5), Report(2, NAN)}) {
    MetricsLog log(file, {});
    log.Write(report);
    log.Flush();
  }
  const auto lines = Lines(file);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["t"], 1);
  EXPECT_EQ(lines[0]["role"], "actor");
  EXPECT_EQ(lines[0]["id"], 3);
  EXPECT_EQ(lines[0]["pid"], 77);
  EXPECT_EQ(lines[0]["env_steps"], 5);
  EXPECT_TRUE(lines[1]["env_steps"].is_null());
}

TEST(MetricsLog, ReplacesWhatIsNotUtf8) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsMessage report = Report(1);
  report.host = "\xff";
  report.names = {"\xfe"};
  MetricsLog log(file, {});
  log.Write(report);
  log.Flush();
  EXPECT_EQ(Lines(file).at(0).at("host"), "\xef\xbf\xbd");
}

TEST(MetricsLog, KeepsCountsExactAndRoundsOtherFigures) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsLog log(file, {});
  log.Write(Report(1'795'252'995.7923207, 123'456'789'012));
  log.Write(Report(1'795'252'996.7923207, 9444.184449640406));
  log.Write(Report(1'795'252'997.7923207, -1.25e-9));
  log.Flush();
  const auto lines = Lines(file);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0]["t"], 1'795'252'995.792);
  EXPECT_EQ(lines[0]["env_steps"], 123'456'789'012);
  EXPECT_EQ(lines[1]["env_steps"], 9444.18);
  EXPECT_EQ(lines[2]["env_steps"], -1.25e-9);
}

// Reports of three processes every second for `hours`; bytes of the file.
uint64_t BytesAfter(double hours) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsLog log(file, {.burst_bytes = 20'000, .bytes_per_hour = 40'000, .most_bytes = 1'000'000});
  for (int second = 0; second < static_cast<int>(3600 * hours); ++second) {
    for (uint32_t id = 0; id < 3; ++id) {
      MetricsMessage report = Report(second);
      report.id = id;
      log.Write(report);
      log.Flush();
    }
  }
  return std::filesystem::file_size(file);
}

TEST(MetricsLog, AnHourCostsItsBudgetWhateverTheProcessesSay) {
  EXPECT_LE(BytesAfter(1), 61'000u);
  EXPECT_GE(BytesAfter(1), 50'000u);
  EXPECT_LE(BytesAfter(3), 141'000u);
}

TEST(MetricsLog, AlwaysWritesTheFirstReportOfAProcessAndItsExitReason) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsLog log(file, {.burst_bytes = 0, .bytes_per_hour = 1, .most_bytes = 100'000});
  MetricsMessage report = Report(1);
  for (int i = 0; i < 5; ++i) log.Write(report);
  report.state = "stopping";
  log.Write(report);
  report.pid = 78;
  log.Write(report);
  log.Flush();
  EXPECT_EQ(Lines(file).size(), 3u);
  EXPECT_EQ(log.lines_left_out(), 4u);
}

TEST(MetricsLog, StopsAtItsSizeLimit) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsLog log(file, {.most_bytes = 400});
  EXPECT_FALSE(log.full());
  for (int second = 0; second < 20; ++second) {
    log.Write(Report(second));
    log.Flush();
  }
  EXPECT_TRUE(log.full());
  EXPECT_LE(std::filesystem::file_size(file), 400u);
  EXPECT_GE(Lines(file).size(), 3u);
}

TEST(MetricsLog, NamesAFileThatCannotBeOpened) {
  EXPECT_THROW(MetricsLog("/absent/metrics.jsonl", {}), Error);
}

// A limit on the file's size stands in for a full disk; it is lifted as if room had been made.
TEST(MetricsLog, LinesThatDoNotFitTheDiskAreWrittenOnceThereIsRoom) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    MetricsLog log(file, {});
    log.Write(Report(0));
    log.Flush();
    setrlimit(RLIMIT_FSIZE, std::array<rlimit, 1>{{{200, RLIM_INFINITY}}}.data());
    int failed = 0;
    for (int second = 1; second <= 5; ++second) {
      log.Write(Report(second));
      try {
        log.Flush();
      } catch (const Error& e) {
        failed += std::string(e.what()).find("metrics.jsonl") != std::string::npos;
      }
    }
    setrlimit(RLIMIT_FSIZE, std::array<rlimit, 1>{{{RLIM_INFINITY, RLIM_INFINITY}}}.data());
    log.Flush();
    _exit(failed);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_GE(WEXITSTATUS(status), 3) << "the disk was full for most of them";
  const auto lines = Lines(file);
  ASSERT_EQ(lines.size(), 6u);
  for (size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i]["t"], i);
}

TEST(MetricsLog, KeepsTheNewestLinesWhileTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsLog log(file, {.kept_bytes = 300});
  for (int second = 0; second < 20; ++second) log.Write(Report(second));
  EXPECT_GT(log.lines_left_out(), 10u);
  log.Flush();
  const auto lines = Lines(file);
  ASSERT_GE(lines.size(), 2u);
  EXPECT_EQ(lines.back()["t"], 19);
}

TEST(MetricsLog, GoesOnBehindALineThatWasCutOff) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  WriteFileAtomically(file, "{\"t\": 1}\n{\"t\":");
  MetricsLog log(file, {});
  log.Write(Report(2));
  log.Flush();
  EXPECT_TRUE(ReadFile(file).starts_with("{\"t\": 1}\n{\"t\":\n{\"t\":2.000,")) << ReadFile(file);
}

}  // namespace
}  // namespace shoal::launch

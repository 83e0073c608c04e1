#include "launch/metrics_log.h"

#include <gtest/gtest.h>

#include <cmath>
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
  EXPECT_TRUE(MetricsLog(file, {}).Write(Report(1, 5)));
  EXPECT_TRUE(MetricsLog(file, {}).Write(Report(2, NAN)));
  const auto lines = Lines(file);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["t"], 1);
  EXPECT_EQ(lines[0]["role"], "actor");
  EXPECT_EQ(lines[0]["id"], 3);
  EXPECT_EQ(lines[0]["pid"], 77);
  EXPECT_EQ(lines[0]["env_steps"], 5);
  EXPECT_TRUE(lines[1]["env_steps"].is_null());
}

TEST(MetricsLog, ThinsOutWhenLongAndStopsWhenFull) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "metrics.jsonl";
  MetricsLog log(file, {.thin_bytes = 200, .most_bytes = 400, .thin_seconds = 10});
  bool complained = false;
  for (int second = 0; second < 200; ++second) complained |= !log.Write(Report(second));
  const auto lines = Lines(file);
  ASSERT_GE(lines.size(), 4u);
  EXPECT_EQ(lines[1]["t"].get<double>() - lines[0]["t"].get<double>(), 1);
  EXPECT_EQ(lines.back()["t"].get<double>() - lines[lines.size() - 2]["t"].get<double>(), 10);
  EXPECT_LE(std::filesystem::file_size(file), 400u);
  EXPECT_TRUE(complained);
  EXPECT_EQ(log.lines_left_out() + lines.size(), 200u);
}

TEST(MetricsLog, ComplainsOnce) {
  const TemporaryFolder folder;
  MetricsLog log(folder.path() / "metrics.jsonl",
                 {.thin_bytes = 1000, .most_bytes = 10, .thin_seconds = 10});
  EXPECT_FALSE(log.Write(Report(1)));
  EXPECT_TRUE(log.Write(Report(2)));
}

TEST(MetricsLog, NamesAFileThatCannotBeOpened) {
  EXPECT_THROW(MetricsLog("/absent/metrics.jsonl", {}), Error);
}

}  // namespace
}  // namespace shoal::launch

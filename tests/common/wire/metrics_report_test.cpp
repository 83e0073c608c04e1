// SPDX-License-Identifier: Apache-2.0
#include "common/wire/metrics_report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <map>
#include <thread>
#include <vector>

#include "common/wire/process_name.h"
#include "common/wire/scoped_seconds.h"

namespace shoal {
namespace {

std::map<std::string, double> Figures(const MetricsReport& report) {
  std::map<std::string, double> figures;
  for (size_t i = 0; i < report.message().names.size(); ++i) {
    EXPECT_TRUE(figures.emplace(report.message().names[i], report.message().values[i]).second)
        << report.message().names[i] << " twice";
  }
  return figures;
}

// Waits until `seconds` after `start`: reports need intervals of some length.
void WaitUntilSince(SteadyTime start, double seconds) {
  while (SecondsSince(start) < seconds) std::this_thread::yield();
}

TEST(MetricsReport, IsDueOnceASecond) {
  const SteadyTime start = Now();
  MetricsReport report(ProcessName::Actor(3));
  EXPECT_FALSE(report.Due(start + std::chrono::milliseconds(500)));
  EXPECT_TRUE(report.Due(start + std::chrono::milliseconds(1500)));
  EXPECT_FALSE(report.Due(start + std::chrono::milliseconds(1600)));
  EXPECT_TRUE(report.Due(start + std::chrono::milliseconds(2600)));
}

TEST(MetricsReport, SaysWhoReports) {
  MetricsReport report(ProcessName::Actor(3));
  report.Begin("blocked");
  EXPECT_EQ(report.message().role, "actor");
  EXPECT_EQ(report.message().id, 3u);
  EXPECT_EQ(report.message().pid, getpid());
  EXPECT_EQ(report.message().state, "blocked");
  EXPECT_GT(report.message().time, 1.6e9);
  EXPECT_TRUE(report.message().names.empty());
}

TEST(MetricsReport, SharesAndRatesAreOfTheIntervalThatEnded) {
  const SteadyTime start = Now();
  MetricsReport report(ProcessName::Actor(0));
  WaitUntilSince(start, 0.12);
  report.Begin("running");
  const double until_first = SecondsSince(start);
  report.AddSeconds("physics", 0.03);
  report.AddRate("steps_per_second", 30);
  const double first = 30 / Figures(report).at("steps_per_second");
  EXPECT_GE(first, 0.11);
  EXPECT_LE(first, until_first);
  EXPECT_NEAR(Figures(report).at("seconds_physics"), 0.03, 1e-9);
  EXPECT_NEAR(Figures(report).at("share_physics"), 0.03 / first, 1e-9);
  WaitUntilSince(start, 0.25);
  report.Begin("running");
  const double until_second = SecondsSince(start);
  report.AddSeconds("physics", 0.09);
  report.AddRate("steps_per_second", 90);
  const double second = 60 / Figures(report).at("steps_per_second");
  EXPECT_GE(first + second, 0.24);
  EXPECT_LE(first + second, until_second);
  EXPECT_NEAR(Figures(report).at("seconds_physics"), 0.09, 1e-9);
  EXPECT_NEAR(Figures(report).at("share_physics"), 0.06 / second, 1e-9);
}

TEST(MetricsReport, ASharesPartAndWholeAreThoseOfTheIntervalThatEnded) {
  MetricsReport report(ProcessName{.role = "replay"});
  report.Begin("running");
  report.AddShare("relabelled_share", 0, 0);
  EXPECT_TRUE(report.message().names.empty()) << "of nothing there is no share";
  report.AddShare("relabelled_share", 30, 40);
  EXPECT_EQ(Figures(report).at("relabelled_share"), 0.75);
  report.Begin("running");
  report.AddShare("relabelled_share", 40, 80);
  report.AddShare("zero_reward_share", 8, 80);
  EXPECT_EQ(Figures(report).at("relabelled_share"), 0.25);
  EXPECT_EQ(Figures(report).at("zero_reward_share"), 0.1);
}

TEST(MetricsReport, AShareIsNeverMoreThanTheWhole) {
  const SteadyTime start = Now();
  MetricsReport report(ProcessName{.role = "replay"});
  WaitUntilSince(start, 0.12);
  report.Begin("running");
  report.AddSeconds("sending", 3.5);  // a send that has waited since long before
  EXPECT_EQ(Figures(report).at("share_sending"), 1);
  EXPECT_EQ(Figures(report).at("seconds_sending"), 3.5);
}

TEST(MetricsReport, AnIntervalTooShortHasNoShares) {
  MetricsReport report(ProcessName::Actor(0));
  report.Begin("running");
  report.AddSeconds("physics", 0.03);
  EXPECT_EQ(Figures(report).count("share_physics"), 0u);
  EXPECT_EQ(Figures(report).count("seconds_physics"), 1u);
}

TEST(MetricsReport, QuantilesOfNothingAreLeftOut) {
  MetricsReport report(ProcessName::Actor(0));
  QuantileWindow window;
  report.Begin("running");
  report.AddQuantiles("lag", &window);
  EXPECT_TRUE(Figures(report).empty());
  window.Add(4);
  report.AddQuantiles("lag", &window);
  EXPECT_EQ(Figures(report).at("lag_p50"), 4);
  EXPECT_EQ(Figures(report).at("lag_p90"), 4);
  EXPECT_EQ(Figures(report).at("lag_p99"), 4);
}

TEST(Resources, OpenFilesAreCounted) {
  const int before = OpenFiles();
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  EXPECT_EQ(OpenFiles(), before + 2);
  close(ends[0]);
  close(ends[1]);
  EXPECT_EQ(OpenFiles(), before);
}

TEST(Resources, MemoryAndProcessorTimeGrowWithUse) {
  const double memory = ResidentMegabytes(), cpu = CpuSeconds();
  const std::vector<char> used(64'000'000, 1);
  EXPECT_GT(ResidentMegabytes(), memory + 50);
  double total = 0;
  {
    const ScopedSeconds timed(total);
    WaitUntilSince(Now(), 0.05);
  }
  EXPECT_GE(total, 0.05);
  EXPECT_GT(CpuSeconds(), cpu);
}

}  // namespace
}  // namespace shoal

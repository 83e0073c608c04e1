// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/seed_figures.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

SeedFigures Three() {
  SeedFigures figures;
  figures.Add(0.9975, 400, -0.7, 0.01);
  figures.Add(0.96, 400, -0.9, 0.02);
  figures.Add(0.9375, 400, -1.1, 0.03);
  return figures;
}

TEST(FormatValue, HasFourDigits) {
  EXPECT_EQ(FormatValue(688.333), "688.3");
  EXPECT_EQ(FormatValue(1234.4), "1234");
  EXPECT_EQ(FormatValue(-1.659), "-1.66");
  EXPECT_EQ(FormatValue(759), "759");
  EXPECT_EQ(FormatValue(700.04), "700");
  EXPECT_EQ(FormatValue(0), "0");
}

TEST(SeedFigures, OneSeedHasWilsonsIntervalOfItsEpisodes) {
  SeedFigures figures;
  figures.Add(292.0 / 300, 300, -1, 0.02);
  EXPECT_EQ(FormatSuccess(figures), "97.3 % [94.8, 98.6] (292/300)");
  const auto json = SuccessJson(figures);
  EXPECT_NEAR(json.at("wilson95").at(0).get<double>(), Wilson95(292, 300).low, 1e-12);
  EXPECT_TRUE(json.at("ci95").is_null());
  EXPECT_EQ(json.at("seeds"), 1);
}

// 399, 384 and 375 of 400.
TEST(SeedFigures, SeveralSeedsHaveAnIntervalOverSeeds) {
  EXPECT_EQ(FormatSuccess(Three()), "96.5 % [89.0, 100.0] (3 seeds, 1158/1200)");
  const auto json = SuccessJson(Three());
  EXPECT_EQ(json.at("pooled"), 0.965);
  EXPECT_EQ(json.at("episodes"), 1200);
  EXPECT_NEAR(json.at("mean").get<double>(), 0.965, 1e-12);
  EXPECT_NEAR(json.at("ci95").at(0).get<double>(), 0.889704, 1e-6);
  EXPECT_EQ(json.at("ci95").at(1), 1.0);
  EXPECT_TRUE(json.at("wilson95").is_null()) << "that of one policy alone";
}

// 100 of 100 and 200 of 400: seeds are the unit, whatever the number of their episodes.
TEST(SeedFigures, TheMeanIsOfSeedsNotOfEpisodes) {
  SeedFigures figures;
  figures.Add(1.0, 100, -1, std::nullopt);
  figures.Add(0.5, 400, -1, std::nullopt);
  EXPECT_EQ(FormatSuccess(figures), "75.0 % [0.0, 100.0] (2 seeds, 300/500)");
  EXPECT_EQ(SuccessJson(figures).at("mean"), 0.75);
  EXPECT_EQ(SuccessJson(figures).at("pooled"), 0.6);
}

TEST(SeedFigures, FailedSeedsAreSaidInTheSameLine) {
  SeedFigures figures = Three();
  figures.failed = 1;
  EXPECT_EQ(FormatSuccess(figures),
            "96.5 % [89.0, 100.0] (3 seeds, 1158/1200; 1 failed: 72.4 % with it as 0)");
  EXPECT_EQ(FormatReturn(figures), "-0.90 [-1.40, -0.40] (3 seeds; 1 failed, left out)");
  EXPECT_EQ(SuccessJson(figures).at("failed"), 1);
  EXPECT_NEAR(SuccessJson(figures).at("mean_with_failed_as_0").get<double>(), 0.72375, 1e-12);
  EXPECT_EQ(ReturnJson(figures).at("failed"), 1);
  SeedFigures none;
  none.failed = 2;
  EXPECT_EQ(FormatReturn(none), "- (2 failed)");
  EXPECT_TRUE(SuccessJson(none).at("mean_with_failed_as_0").is_null());
}

// Student's interval of 0.1 and 1.4 cm is -7.5 to 9.0 cm.
TEST(SeedFigures, DistancesHaveNoIntervalBelowZero) {
  SeedFigures figures;
  figures.Add(1.0, 10, -1, 0.001);
  figures.Add(1.0, 10, -1, 0.014);
  EXPECT_EQ(FormatDistance(figures), "0.8 [0.0, 9.0] (2 seeds)");
  EXPECT_EQ(DistanceJson(figures).at("ci95").at(0), 0.0);
}

TEST(SeedFigures, PrintsTheDigitsThatTheIntervalBears) {
  SeedFigures figures;
  figures.Add(std::nullopt, 50, 1174.592347666025, std::nullopt);
  EXPECT_EQ(FormatReturn(figures), "1175 (1 seed)");
  EXPECT_EQ(FormatSuccess(figures), "-") << "of a task without success";
  EXPECT_EQ(FormatDistance(figures), "-");
  figures.Add(std::nullopt, 50, 1086.8137503600124, std::nullopt);
  figures.Add(std::nullopt, 50, 1300.8473840284348, std::nullopt);
  EXPECT_EQ(FormatReturn(figures), "1187 [920, 1455] (3 seeds)");
  SeedFigures close;
  close.Add(std::nullopt, 50, 866.253, std::nullopt);
  close.Add(std::nullopt, 50, 866.183, std::nullopt);
  EXPECT_EQ(FormatReturn(close), "866.22 [865.77, 866.66] (2 seeds)");
}

}  // namespace
}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/record/evaluation_figures.h"

#include <gtest/gtest.h>

#include "tests/launch/tools/experiment/planted_run.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

TEST(EvaluationFigures, AreTheMeansOfTheFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "eval.json";
  WriteFileAtomically(file, PlantedEvaluation(2000, 0.75, 8, -1.5).dump());
  const EvaluationFigures figures = ReadEvaluationFigures(file);
  EXPECT_EQ(figures.env_steps, 2000u);
  EXPECT_EQ(figures.updates, 200u);
  EXPECT_EQ(figures.wall_seconds, 20);
  EXPECT_EQ(figures.task, "FetchReachDense");
  EXPECT_EQ(figures.checkpoint, "best");
  EXPECT_EQ(figures.episodes, 8u);
  EXPECT_EQ(figures.success, 0.75);
  EXPECT_EQ(figures.return_mean, -1.5);
  EXPECT_EQ(figures.return_std, 0.1);
  EXPECT_EQ(figures.final_distance_mean, 0.02);
}

TEST(EvaluationFigures, OfATaskWithoutSuccessHaveNone) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "eval.json";
  WriteFileAtomically(file, PlantedEvaluation(100, std::nullopt, 2).dump());
  EXPECT_FALSE(ReadEvaluationFigures(file).success);
}

TEST(EvaluationFigures, AFileWithoutASpreadIsRefusedByName) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "eval.json";
  auto evaluation = PlantedEvaluation(100, 0.5, 2);
  evaluation["aggregate"].erase("return_std");
  WriteFileAtomically(file, evaluation.dump());
  const std::string message = ErrorMessage([&] { ReadEvaluationFigures(file); });
  EXPECT_NE(message.find(file.string()), std::string::npos) << message;
  EXPECT_NE(message.find("return_std"), std::string::npos) << message;
}

}  // namespace
}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "learner/training_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "learner/agent/frame_figures.h"

namespace shoal::learner {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr SteadyTime kStart{seconds(1000)};

// Figures of a run that learns.
UpdateFigures Healthy() {
  UpdateFigures figures;
  figures.Set(kCriticLoss, 0.5);
  figures.Set(kTemperature, 0.05);
  figures.Set(kActionSaturation, 0.3);
  figures.Set(kFrameSpread, 40);
  figures.Set(kFrozenCameras, 0);
  return figures;
}

class TrainingGuardTest : public testing::Test {
 protected:
  // Warnings after one report with `critic_loss` over a whole window of updates.
  std::vector<std::string> AfterLoss(float critic_loss) {
    UpdateFigures figures = Healthy();
    figures.Replace(kCriticLoss, critic_loss);
    now_ += seconds(1);
    return guard_.Check(figures, TrainingGuard::kLossUpdates, now_);
  }

  TrainingGuard guard_{Config()};
  SteadyTime now_ = kStart;
};

TEST_F(TrainingGuardTest, IsSilentAboutAHealthyRun) {
  for (int i = 0; i < 100; ++i) EXPECT_THAT(AfterLoss(i % 2 ? 0.5f : 0.4f), IsEmpty());
  EXPECT_EQ(guard_.warnings(), 0u);
}

TEST_F(TrainingGuardTest, NamesFramesOfOneColour) {
  UpdateFigures figures = Healthy();
  figures.Replace(kFrameSpread, 0.25f);
  EXPECT_THAT(guard_.Check(figures, 10, now_), ElementsAre(HasSubstr("0.250 grey levels")));
}

TEST_F(TrainingGuardTest, IsSilentAboutWhatIsNotReported) {
  EXPECT_THAT(guard_.Check(UpdateFigures(), 10'000, now_), IsEmpty());
  UpdateFigures figures;
  figures.Set(kTemperature, 0);
  EXPECT_THAT(guard_.Check(figures, 10, now_), ElementsAre(HasSubstr("entropy unknown")));
}

TEST_F(TrainingGuardTest, NamesFrozenCameras) {
  UpdateFigures figures = Healthy();
  figures.Replace(kFrozenCameras, 0.5f);  // in every second batch: a coincidence
  EXPECT_THAT(guard_.Check(figures, 10, now_), IsEmpty());
  figures.Replace(kFrozenCameras, 1);
  EXPECT_THAT(guard_.Check(figures, 10, now_), ElementsAre(HasSubstr("1.0 camera(s)")));
}

TEST_F(TrainingGuardTest, NamesSaturatedActions) {
  UpdateFigures figures = Healthy();
  figures.Replace(kActionSaturation, 0.97f);
  EXPECT_THAT(guard_.Check(figures, 10, now_), ElementsAre(HasSubstr("97.0 %")));
}

TEST_F(TrainingGuardTest, NamesACollapsedTemperature) {
  UpdateFigures figures = Healthy();
  figures.Replace(kTemperature, 5e-6f);  // began at 0.1
  EXPECT_THAT(guard_.Check(figures, 10, now_),
              ElementsAre(testing::AllOf(HasSubstr("5e-06"), HasSubstr("0.1"))));
}

TEST_F(TrainingGuardTest, RepeatsAWarningOnceAMinuteAndCountsIt) {
  UpdateFigures figures = Healthy();
  figures.Replace(kActionSaturation, 1);
  int warnings = 0;
  for (int second = 0; second < 150; ++second) {
    warnings += static_cast<int>(guard_.Check(figures, 10, kStart + seconds(second)).size());
  }
  EXPECT_EQ(warnings, 3);
  EXPECT_EQ(guard_.warnings(), 3u);
}

TEST_F(TrainingGuardTest, NamesACriticLossThatKeepsRising) {
  float loss = 0.1f;
  for (int i = 0; i < TrainingGuard::kRises; ++i) {
    EXPECT_THAT(AfterLoss(loss), IsEmpty()) << i;
    loss *= 2;
  }
  EXPECT_THAT(AfterLoss(loss), ElementsAre(HasSubstr("5 rises in a row, once 0.1")));
}

TEST_F(TrainingGuardTest, ASlowRiseOfTheCriticLossIsNotWorthALine) {
  float loss = 0.1f;
  for (int i = 0; i < 20; ++i) {
    EXPECT_THAT(AfterLoss(loss), IsEmpty()) << i;
    loss *= 1.05f;
  }
}

TEST_F(TrainingGuardTest, AFallEndsARise) {
  for (const float loss : {0.1f, 0.2f, 0.5f, 1.0f, 2.0f, 1.9f, 4.0f, 8.0f, 16.0f, 32.0f}) {
    EXPECT_THAT(AfterLoss(loss), IsEmpty()) << loss;
  }
  EXPECT_EQ(AfterLoss(64.0f).size(), 1u);
}

TEST(DescribeNonFinite, NamesTheUpdateAndItsNumbers) {
  UpdateFigures figures = Healthy();
  figures.Replace(kCriticLoss, std::numeric_limits<float>::quiet_NaN());

  const std::string line = DescribeNonFinite(figures, 41);
  EXPECT_THAT(line, HasSubstr("update 42"));
  EXPECT_THAT(line, HasSubstr("critic_loss nan"));
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_THAT(DescribeNonFinite(UpdateFigures(), 41), HasSubstr("its batch"));
}

}  // namespace
}  // namespace shoal::learner

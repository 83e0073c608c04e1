// SPDX-License-Identifier: Apache-2.0
#include "learner/sample_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "learner/batch_source.h"
#include "learner/device/device_engine.h"
#include "tests/learner/training_loop_fixture.h"

namespace shoal::learner {
namespace {

using testing::ElementsAre;

TEST(SampleErrors, ASamplesErrorIsTheMeanOfItsCopiesRows) {
  SampleErrorCollector collector(/*copies=*/2);
  std::vector<float> reward(4);
  std::vector<uint64_t> first{7, 7, 9, 9}, second{5, 5, 5, 5};
  const auto batch = [&](uint64_t request, std::vector<uint64_t>* ids) {
    Batch drawn{.view = {}, .request = request};
    drawn.view.reward = reward;
    drawn.view.id = *ids;
    return drawn;
  };
  collector.OnBatch(batch(11, &first));
  collector.OnBatch(batch(12, &second));
  first.assign(4, 0);  // the batch's memory is used again
  const SampleErrors of_first = collector.TakeOldest(std::vector<float>{1, 2, 0, 0.5f});
  EXPECT_EQ(of_first.request, 11u);
  EXPECT_THAT(of_first.ids, ElementsAre(7, 9));
  EXPECT_THAT(of_first.errors, ElementsAre(1.5f, 0.25f));
  const SampleErrors of_second = collector.TakeOldest(std::vector<float>{1, 1, 3, 3});
  EXPECT_EQ(of_second.request, 12u);
  EXPECT_THAT(of_second.ids, ElementsAre(5, 5));
  EXPECT_THAT(of_second.errors, ElementsAre(1, 3));
}

// Batches whose rows have their own ids and probabilities. Keeps the errors that it takes.
class PrioritisedBatches : public TrainingLoopTest {
 protected:
  std::vector<SampleErrors> ErrorsWith(size_t delay) {
    run_.config.replay.priorities = "proportional";
    delay_ = delay;
    Say(RunState::kRunning);
    std::vector<SampleErrors> taken;
    Train(9, [&](PlayedBatches& batches) { batches.taken = &taken; });
    std::filesystem::remove_all(folder_.path() / "checkpoints");
    return taken;
  }
};

TEST_F(PrioritisedBatches, ErrorsOfUpdatesInFlightAreThoseOfTheirBatches) {
  const std::vector<SampleErrors> at_once = ErrorsWith(0), later = ErrorsWith(2);
  ASSERT_EQ(at_once.size(), 9u);
  ASSERT_EQ(later.size(), 9u);
  for (size_t i = 0; i < at_once.size(); ++i) {
    EXPECT_EQ(at_once[i].request, i + 1);
    EXPECT_EQ(later[i].request, i + 1);
    ASSERT_EQ(at_once[i].errors.size(), static_cast<size_t>(run_.config.learner.batch));
    EXPECT_EQ(later[i].errors, at_once[i].errors);
    EXPECT_EQ(later[i].ids, at_once[i].ids);
    EXPECT_EQ(at_once[i].ids[1], 1000 * (i + 1) + 1);
    for (const float error : at_once[i].errors) EXPECT_GT(error, 0);
    if (i > 0) {
      EXPECT_NE(at_once[i].errors, at_once[i - 1].errors);
    }
  }
}

// A request is made after this number of later updates has begun, besides the credits.
TEST(SampleErrors, AreKnownWhenTheirRequestIsMade) {
  EXPECT_GT(BatchSource::kErrorDelay, uint64_t{device::DeviceEngine::kInFlight});
}

}  // namespace
}  // namespace shoal::learner

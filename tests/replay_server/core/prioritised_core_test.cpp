// SPDX-License-Identifier: Apache-2.0
// Prioritised sampling in the replay core: requests that bring errors, and repeated requests.
#include <gmock/gmock.h>

#include "tests/replay_server/core/replay_core_fixture.h"

namespace shoal::replay {
namespace {

class PrioritisedCoreTest : public ReplayCoreTest {
 protected:
  PrioritisedCoreTest() {
    run_.config.replay.priorities = "proportional";
    run_.config.replay.priority_exponent = 1;
    run_.config.learner.request_credits = 8;
    Start();
    Store(&actor_, 1, 40);
  }

  // Asks for a batch with a request that brings errors.
  void AskWith(uint64_t request, const std::vector<uint64_t>& ids, const std::vector<float>& errors,
               uint64_t released = 0, uint64_t session = 1) {
    EXPECT_EQ(core_->TakeRequest({.spec_hash = run_.spec.Hash(),
                                  .learner_session = session,
                                  .request = request,
                                  .batch = static_cast<uint32_t>(run_.config.learner.batch),
                                  .schema_hash = BatchSchemaOf(run_).Hash(),
                                  .released = released,
                                  .error_ids = ids,
                                  .errors = errors}),
              RequestFate::kQueued);
  }
  std::vector<uint64_t> Drawn() const {
    std::vector<uint64_t> ids;
    for (const auto& element : core_->last_plan().elements) ids.push_back(element.id);
    return ids;
  }
  // A large error of this sample makes all samples of a batch this one.
  static constexpr float kLargest = 16'000;
};

TEST_F(PrioritisedCoreTest, ARequestBringsPrioritiesForItselfAndLaterRequests) {
  AskWith(1, {}, {});
  ASSERT_FALSE(Answer().empty());
  const std::vector<uint64_t> first = Drawn();
  EXPECT_THAT(first, testing::Contains(testing::Ne(first[0])));
  std::vector<uint64_t> all;
  std::vector<float> errors;
  for (uint64_t id = core_->ring().oldest_id(); id <= core_->ring().last_id(); ++id) {
    if (!core_->index().Sampleable(id)) continue;
    all.push_back(id);
    errors.push_back(id == first[0] ? kLargest : 0);
  }
  AskWith(2, all, errors);
  EXPECT_EQ(core_->counters().priorities_set, 0u) << "before the request is answered";
  ASSERT_FALSE(Answer().empty());
  EXPECT_THAT(Drawn(), testing::Each(first[0]));
  AskWith(3, {first[0], core_->ring().last_id() + 1}, {1, 1});
  ASSERT_FALSE(Answer().empty());
  EXPECT_EQ(core_->counters().priorities_set, all.size() + 1);
  EXPECT_EQ(core_->counters().priorities_ignored, 1u);
}

TEST_F(PrioritisedCoreTest, ABatchHasTheProbabilitiesOfItsDraws) {
  AskWith(1, {core_->ring().last_id() - 1}, {3});
  const std::vector<uint8_t> bytes = Answer();
  ASSERT_FALSE(bytes.empty());
  const AlignedBytes memory(bytes.size());
  std::memcpy(memory.data(), bytes.data(), bytes.size());
  const BatchView view = core_->batch_schema().View(memory.data());
  ASSERT_EQ(view.probability.size(), view.id.size());
  for (size_t row = 0; row < view.id.size(); ++row) {
    const auto& element = core_->last_plan().elements[row];
    EXPECT_EQ(view.id[row], element.id);
    EXPECT_EQ(view.probability[row], static_cast<float>(element.probability));
    EXPECT_GT(view.probability[row], 0.5 / static_cast<double>(core_->index().sampleable()));
  }
}

// The priorities have changed since the first answer, but the samples and the bytes have not.
TEST_F(PrioritisedCoreTest, ARepeatedRequestGetsTheBatchOfItsFirstAnswer) {
  AskWith(1, {}, {});
  const std::vector<uint8_t> first = Answer();
  const std::vector<uint64_t> ids = Drawn();
  AskWith(2, {ids[0]}, {kLargest});
  Answer();
  const uint64_t set = core_->counters().priorities_set;
  AskWith(2, {ids[0]}, {kLargest});
  Answer();
  EXPECT_EQ(core_->counters().priorities_set, set) << "set once";
  AskWith(1, {}, {});
  EXPECT_EQ(Answer(), first);
  EXPECT_EQ(core_->counters().repeated_batches, 2u);
}

TEST_F(PrioritisedCoreTest, PlansOfReleasedBatchesAndOfFormerLearnersAreDropped) {
  AskWith(1, {}, {});
  const std::vector<uint8_t> first = Answer();
  AskWith(2, {Drawn()[0]}, {kLargest}, /*released=*/1);
  Answer();
  AskWith(1, {}, {}, 0, /*session=*/2);
  EXPECT_NE(Answer(), first) << "the new learner's first request finds the new priorities";
}

// A repeated request cannot get samples that have been overwritten.
TEST_F(PrioritisedCoreTest, ARepeatedRequestIsDrawnAgainIfASampleIsGone) {
  AskWith(1, {}, {});
  ASSERT_FALSE(Answer().empty());
  Store(&actor_, 41, 80);
  AskWith(1, {}, {});
  ASSERT_FALSE(Answer().empty());
  for (const uint64_t id : Drawn()) EXPECT_TRUE(core_->index().Sampleable(id)) << id;
}

TEST_F(PrioritisedCoreTest, ARestartedServerGivesEverySampleTheFirstPriority) {
  run_.config.replay.storage = "file";
  Start();
  Store(&actor_, 1, 40);
  AskWith(1, {}, {});
  Answer();
  AskWith(2, {Drawn()[0]}, {kLargest});
  ASSERT_FALSE(Answer().empty());
  EXPECT_GT(core_->selector().largest_priority(), 1000);
  core_.reset();
  Start();
  EXPECT_EQ(core_->selector().largest_priority(), 1);
  AskWith(3, {}, {});
  ASSERT_FALSE(Answer().empty());
  for (const auto& element : core_->last_plan().elements) {
    EXPECT_NEAR(element.probability, 1 / static_cast<double>(core_->index().sampleable()), 1e-9);
  }
}

}  // namespace
}  // namespace shoal::replay

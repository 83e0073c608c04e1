// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/request_queue.h"

#include <gtest/gtest.h>

namespace shoal::replay {
namespace {

class RequestQueueTest : public testing::Test {
 protected:
  RequestFate Offer(uint64_t request, uint64_t session = 1, uint64_t after_steps = 0) {
    return queue_.Offer({.spec_hash = 5,
                         .learner_session = session,
                         .request = request,
                         .after_steps = after_steps,
                         .schema_hash = 64});
  }
  uint64_t NextId() {
    const auto next = queue_.Next(/*stored_steps=*/100);
    return next ? next->request : 0;
  }

  RequestQueue queue_{5, 64, 3};
};

TEST_F(RequestQueueTest, AnswersInOrderOfIdsWhateverTheOrderOfArrival) {
  Offer(2);
  Offer(1);
  Offer(3);
  for (uint64_t id = 1; id <= 3; ++id) {
    EXPECT_EQ(NextId(), id);
    queue_.Pop();
  }
  EXPECT_EQ(NextId(), 0u);
}

TEST_F(RequestQueueTest, HoldsNoMoreThanTheCredits) {
  for (uint64_t id = 1; id <= 3; ++id) EXPECT_EQ(Offer(id), RequestFate::kQueued);
  EXPECT_EQ(Offer(4), RequestFate::kFull);
  EXPECT_EQ(Offer(3), RequestFate::kAlreadyQueued);
  EXPECT_EQ(queue_.size(), 3u);
}

TEST_F(RequestQueueTest, AnAnsweredRequestIsAnsweredAgain) {
  Offer(1);
  EXPECT_FALSE(queue_.Answered(*queue_.Next(0)));
  queue_.Pop();
  EXPECT_EQ(Offer(1), RequestFate::kQueued);
  EXPECT_TRUE(queue_.Answered(*queue_.Next(0)));
}

TEST_F(RequestQueueTest, ANewLearnerSessionDiscardsTheFormerOnesRequests) {
  Offer(7);
  queue_.Pop();
  Offer(8);
  EXPECT_EQ(Offer(1, /*session=*/2), RequestFate::kQueued);
  EXPECT_EQ(queue_.size(), 1u);
  EXPECT_FALSE(queue_.Answered(*queue_.Next(0)));
  EXPECT_EQ(Offer(9, /*session=*/1), RequestFate::kStale);
  EXPECT_EQ(queue_.learner_session(), 2u);
}

TEST_F(RequestQueueTest, WhatTheLearnerIsDoneWithWaitsNoMore) {
  Offer(1);
  Offer(2);
  Offer(3);
  EXPECT_EQ(
      queue_.Offer(
          {.spec_hash = 5, .learner_session = 1, .request = 4, .schema_hash = 64, .released = 2}),
      RequestFate::kQueued);
  EXPECT_EQ(queue_.size(), 2u);
  EXPECT_EQ(NextId(), 3u);
}

TEST_F(RequestQueueTest, WaitsForTheStepsARequestNames) {
  Offer(1, 1, /*after_steps=*/50);
  Offer(2, 1);
  EXPECT_FALSE(queue_.Next(49)) << "and nothing overtakes it";
  EXPECT_EQ(queue_.Next(50)->request, 1u);
}

TEST_F(RequestQueueTest, RefusesAnotherSpecOrSchema) {
  SampleRequest request{
      .spec_hash = 6, .learner_session = 1, .request = 1, .after_steps = 0, .schema_hash = 64};
  EXPECT_EQ(queue_.Offer(request), RequestFate::kWrongSpec);
  request.spec_hash = 5;
  request.schema_hash = 63;
  EXPECT_EQ(queue_.Offer(request), RequestFate::kWrongSchema);
  EXPECT_EQ(queue_.learner_session(), 0u) << "it did not replace the learner";
}

}  // namespace
}  // namespace shoal::replay

// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/service_inbox.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/replay_server/record_script.h"

namespace shoal::replay {
namespace {

using std::chrono::seconds;

class ServiceInboxTest : public testing::Test {
 protected:
  const ObservationSpec spec_ = TinySpec(1);
  const uint64_t chunk_bytes_ = 4 * static_cast<uint64_t>(RecordLayout(spec_).record_bytes());
  ServiceInbox inbox_{spec_.Hash(), chunk_bytes_, 2};
  RecordScript script_{spec_, 3, 30};
};

TEST_F(ServiceInboxTest, HandsOverCopiesInOrder) {
  inbox_.OnChunk(script_.Chunk(1, 2));
  inbox_.OnChunk(script_.Chunk(3, 4));
  inbox_.OnRequest({.spec_hash = 1, .learner_session = 2, .request = 3, .batch = 4});
  EXPECT_EQ(inbox_.Depth(), 3u);
  const auto arrivals = inbox_.Wait(Now());
  ASSERT_EQ(arrivals.chunks.size(), 2u);
  const TransitionChunk& chunk = arrivals.chunks[1]->chunk;
  EXPECT_EQ(chunk.first_sequence, 3u);
  EXPECT_EQ(chunk.actor, 3u);
  const auto sent = script_.Chunk(3, 4).payload;
  EXPECT_TRUE(std::ranges::equal(chunk.payload, sent));
  EXPECT_NE(chunk.payload.data(), sent.data());
  EXPECT_EQ(reinterpret_cast<uintptr_t>(chunk.payload.data()) % 8, 0u);
  ASSERT_EQ(arrivals.requests.size(), 1u);
  EXPECT_EQ(arrivals.requests[0].request, 3u);
  EXPECT_EQ(inbox_.Depth(), 0u);
}

TEST_F(ServiceInboxTest, DropsAndCountsWhenNoBufferIsFree) {
  for (uint64_t i = 0; i < 5; ++i) inbox_.OnChunk(script_.Chunk(1 + i, 1));
  EXPECT_EQ(inbox_.DroppedChunks(), 3u);
  auto arrivals = inbox_.Wait(Now());
  ASSERT_EQ(arrivals.chunks.size(), 2u);
  inbox_.OnChunk(script_.Chunk(3, 1));
  EXPECT_EQ(inbox_.DroppedChunks(), 4u) << "both buffers are still out";
  inbox_.Release(std::move(arrivals.chunks[0]));
  inbox_.OnChunk(script_.Chunk(3, 1));
  EXPECT_EQ(inbox_.DroppedChunks(), 4u);
  inbox_.SetMaxChunks(3);
  inbox_.OnChunk(script_.Chunk(4, 1));
  EXPECT_EQ(inbox_.DroppedChunks(), 4u);
  EXPECT_EQ(inbox_.Depth(), 2u);
}

TEST_F(ServiceInboxTest, LeavesOutPayloadsOfAnotherSpecAndOversizedOnes) {
  TransitionChunk chunk = script_.Chunk(1, 2);
  chunk.spec_hash ^= 1;
  inbox_.OnChunk(chunk);
  inbox_.OnChunk(script_.Chunk(1, 5));
  const auto arrivals = inbox_.Wait(Now());
  ASSERT_EQ(arrivals.chunks.size(), 2u);
  EXPECT_TRUE(arrivals.chunks[0]->chunk.payload.empty());
  EXPECT_NE(arrivals.chunks[0]->chunk.spec_hash, spec_.Hash());
  EXPECT_TRUE(arrivals.chunks[1]->chunk.payload.empty());
}

TEST_F(ServiceInboxTest, BoundsRequests) {
  for (size_t i = 0; i < ServiceInbox::kMaxRequests + 7; ++i) inbox_.OnRequest({});
  EXPECT_EQ(inbox_.DroppedRequests(), 7u);
  EXPECT_EQ(inbox_.Depth(), ServiceInbox::kMaxRequests);
}

TEST_F(ServiceInboxTest, WaitsForAnArrivalOrAWake) {
  const SteadyTime start = Now();
  std::thread arrival([this] { inbox_.OnChunk(script_.Chunk(1, 1)); });
  EXPECT_EQ(inbox_.Wait(start + seconds(20)).chunks.size(), 1u);
  arrival.join();
  inbox_.Wake();
  EXPECT_TRUE(inbox_.Wait(start + seconds(20)).chunks.empty());
  EXPECT_LT(Now() - start, seconds(20));
  EXPECT_TRUE(inbox_.Wait(Now()).chunks.empty()) << "a wake counts once";
}

}  // namespace
}  // namespace shoal::replay

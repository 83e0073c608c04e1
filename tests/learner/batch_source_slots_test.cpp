// SPDX-License-Identifier: Apache-2.0
// Batches in shared memory of the replay, and memory that is pinned for a GPU.
#include <algorithm>
#include <thread>
#include <vector>

#include "common/base/error.h"
#include "tests/learner/batch_source_fixture.h"
#include "tests/learner/recording_pin.h"

namespace shoal::learner {
namespace {

TEST_F(BatchSourceTest, ReadsABatchInSharedMemoryWhereItLies) {
  BatchSource& source = Make();
  SlotWriter replay = Replay();
  source.Next(Now());
  EXPECT_TRUE(requests_[0].takes_slots);
  EXPECT_FALSE(source.counters().shared);
  AnswerInSlot(replay, 1, 70);
  const auto batch = source.Next(Now());
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->request, 1u);
  EXPECT_EQ(batch->view.stored_steps, 70u);
  EXPECT_EQ(batch->stored_records, 72u);
  EXPECT_EQ(batch->unsampleable_steps, 7u);
  EXPECT_EQ(batch->view.reward[3], 1.0f);
  EXPECT_EQ(source.counters().shared, true);
  EXPECT_EQ(source.counters().refused_slots, 0u);
}

TEST_F(BatchSourceTest, SaysWhichBatchesAreReadNoMore) {
  BatchSource& source = Make();
  SlotWriter replay = Replay();
  source.Next(Now());
  AnswerInSlot(replay, 1);
  AnswerInSlot(replay, 2);
  ASSERT_TRUE(source.Next(Now()));  // asks for 3 while it reads 1
  ASSERT_TRUE(source.Next(Now()));  // asks for 4 while it reads 2
  ASSERT_EQ(Asked(), (std::vector<uint64_t>{1, 2, 3, 4}));
  EXPECT_EQ(requests_[1].released, 0u);
  EXPECT_EQ(requests_[2].released, 0u) << "1 is being read";
  EXPECT_EQ(requests_[3].released, 1u);
}

TEST_F(BatchSourceTest, AsksOverTheNetworkForWhatItCannotOpen) {
  BatchSource& source = Make();
  uint64_t token = 0;
  source.Next(Now());
  {
    SlotWriter gone = Replay();
    AnswerInSlot(gone, 1);
    token = AnswerInSlot(gone, 2).address.token[0];
  }
  requests_.clear();
  EXPECT_FALSE(source.Next(Now()));
  EXPECT_FALSE(source.Next(Now()));
  EXPECT_EQ(Asked(), (std::vector<uint64_t>{1, 2}));
  EXPECT_EQ(requests_[0].refused_token, token);
  EXPECT_EQ(source.counters().refused_slots, 2u);
  Answer(1);
  const auto batch = source.Next(Now());
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->view.reward[0], 1.0f);
  EXPECT_EQ(source.counters().shared, false);
}

TEST_F(BatchSourceTest, AReplaysSuccessorMayAnswerInItsOwnMemory) {
  BatchSource& source = Make();
  source.Next(Now());
  std::optional<SlotWriter> replay(std::in_place, spec_hash_, kLearnerSession,
                                   BatchSchemaOf(run_).total_bytes(), 3);
  AnswerInSlot(*replay, 1);
  ASSERT_TRUE(source.Next(Now()));
  AnswerInSlot(*replay, 2);
  replay.reset();  // killed: its last message remains valid
  SlotWriter successor = Replay();
  AnswerInSlot(successor, 3);
  for (uint64_t request = 2; request <= 3; ++request) {
    const auto batch = source.Next(Now());
    ASSERT_TRUE(batch) << request;
    EXPECT_EQ(batch->view.reward[0], static_cast<float>(request));
  }
  EXPECT_EQ(source.counters().refused_slots, 0u);
}

// The memory of assembled batches is used in turn, and pinned once.
TEST_F(BatchSourceTest, PinsTheMemoryOfAssembledBatchesAtItsFirstUse) {
  RecordingPin pin;
  pin_ = pin.Function();
  BatchSource& source = Make();
  source.Next(Now());
  const uint64_t bytes = BatchSchemaOf(run_).total_bytes();
  for (uint64_t request = 1; request <= 12; ++request) {
    Answer(request);
    const auto batch = source.Next(Now());
    ASSERT_TRUE(batch) << request;
    const auto* reward = reinterpret_cast<const uint8_t*>(batch->view.reward.data());
    EXPECT_EQ(std::ranges::count_if(pin.given,
                                    [&](std::span<const uint8_t> memory) {
                                      return memory.size() == bytes && reward >= memory.data() &&
                                             reward < memory.data() + bytes;
                                    }),
              1)
        << request;
  }
  EXPECT_LE(pin.given.size(), static_cast<size_t>(run_.config.learner.request_credits + 1));
  EXPECT_EQ(pin.pinned, std::ssize(pin.given));
  source_.reset();
  EXPECT_EQ(pin.pinned, 0);
}

TEST_F(BatchSourceTest, PinsTheSlotsOfAReplayAndOfItsSuccessor) {
  RecordingPin pin;
  pin_ = pin.Function();
  BatchSource& source = Make();
  source.Next(Now());
  std::optional<SlotWriter> replay(std::in_place, spec_hash_, kLearnerSession,
                                   BatchSchemaOf(run_).total_bytes(), 3);
  AnswerInSlot(*replay, 1);
  AnswerInSlot(*replay, 2);
  ASSERT_TRUE(source.Next(Now()));
  ASSERT_TRUE(source.Next(Now()));
  EXPECT_EQ(pin.given.size(), 1u);
  replay.reset();
  SlotWriter successor = Replay();
  AnswerInSlot(successor, 3);
  AnswerInSlot(successor, 4);
  ASSERT_TRUE(source.Next(Now()));
  ASSERT_TRUE(source.Next(Now()));
  EXPECT_EQ(pin.given.size(), 2u);
  EXPECT_EQ(pin.pinned, 1) << "no batch of the first memory is in use";
  source_.reset();
  EXPECT_EQ(pin.pinned, 0);
}

TEST_F(BatchSourceTest, WordsOfSlotsThatNobodyWaitsForAreCounted) {
  BatchSource& source = Make();
  SlotWriter replay = Replay(), former = Replay(kLearnerSession - 1);
  source.Next(Now());
  AnswerInSlot(former, 1);
  AnswerInSlot(replay, 9);
  EXPECT_EQ(source.counters().unknown_parts, 2u);
  EXPECT_FALSE(source.Next(Now()));
  source.OnSlot(AnswerInSlot(replay, 1));
  EXPECT_EQ(source.counters().duplicate_parts, 1u);
  Answer(1);
  EXPECT_EQ(source.counters().duplicate_parts, 2u) << "it is in a slot already";
  Answer(2);
  AnswerInSlot(replay, 2);
  EXPECT_EQ(source.counters().duplicate_parts, 3u) << "its parts came first";
  EXPECT_TRUE(source.Next(Now()));
  EXPECT_TRUE(source.Next(Now()));
}

TEST_F(BatchSourceTest, RefusesSlotsOfAnotherSpec) {
  BatchSource& source = Make();
  source.Next(Now());
  spec_hash_ = 0xabcdef;
  SlotWriter replay = Replay();
  AnswerInSlot(replay, 1);
  EXPECT_THROW(source.Next(Now()), Error);
}

TEST_F(BatchSourceTest, AWordOfASlotWakesWhoWaits) {
  BatchSource& source = Make();
  SlotWriter replay = Replay();
  source.Next(Now());
  std::thread receiver([&] { AnswerInSlot(replay, 1); });
  const auto batch = source.Next(Now() + kLong);
  receiver.join();
  ASSERT_TRUE(batch);
}

}  // namespace
}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/batch_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <iterator>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/base/error.h"
#include "common/config/lockstep.h"
#include "tests/learner/recording_pin.h"
#include "tests/learner/training_fixture.h"

namespace shoal::learner {
namespace {

using std::chrono::milliseconds;

constexpr uint64_t kLearnerSession = 5;
constexpr milliseconds kLong{20'000};  // never waited for in a test that passes

class BatchSourceTest : public testing::Test {
 protected:
  BatchSource& Make(uint64_t first_request = 1, milliseconds resend_after = kLong) {
    source_.emplace(
        run_, kLearnerSession, first_request,
        [this](const SampleRequest& request) {
          requests_.push_back(request);
          return accepting_;
        },
        resend_after, pin_);
    return *source_;
  }

  // Answers a request in one part; its rewards are the request's number.
  void Answer(uint64_t request, uint64_t stored_steps = 100) {
    const BatchSchema schema = BatchSchemaOf(run_);
    std::vector<uint8_t> space(schema.total_bytes() + 64);
    uint8_t* data = space.data() + (64 - reinterpret_cast<uintptr_t>(space.data()) % 64) % 64;
    for (float& reward : schema.View(data).reward) reward = static_cast<float>(request);
    BatchPart part;
    part.spec_hash = spec_hash_;
    part.learner_session = kLearnerSession;
    part.request = request;
    part.parts = 1;
    part.total_bytes = schema.total_bytes();
    part.stored_records = stored_steps + 2;
    part.stored_steps = stored_steps;
    part.unsampleable_steps = stored_steps / 10;
    part.payload = {data, schema.total_bytes()};
    source_->OnPart(part);
  }

  // Answers a request in a slot of `replay`; its rewards are the request's number.
  BatchSlot AnswerInSlot(SlotWriter& replay, uint64_t request, uint64_t stored_steps = 100) {
    uint8_t* slot = replay.FreeSlot();
    if (slot == nullptr) throw std::runtime_error("no free slot");
    const BatchSchema schema = BatchSchemaOf(run_);
    for (float& reward : schema.View(slot).reward) reward = static_cast<float>(request);
    const BatchSlot word = replay.Fill(request, stored_steps + 2, stored_steps, stored_steps / 10);
    source_->OnSlot(word);
    return word;
  }
  SlotWriter Replay(uint64_t session = kLearnerSession) const {
    return {spec_hash_, session, BatchSchemaOf(run_).total_bytes(), 3};
  }

  std::vector<uint64_t> Asked() const {
    std::vector<uint64_t> ids;
    for (const SampleRequest& request : requests_) ids.push_back(request.request);
    return ids;
  }

  RunConfig run_ = SmallRun();  // two credits
  uint64_t spec_hash_ = run_.spec.Hash();
  PinMemory pin_;
  bool accepting_ = true;
  std::vector<SampleRequest> requests_;
  std::optional<BatchSource> source_;
};

TEST_F(BatchSourceTest, KeepsItsCreditsOutstanding) {
  BatchSource& source = Make();
  EXPECT_FALSE(source.Next(Now()));
  EXPECT_EQ(Asked(), (std::vector<uint64_t>{1, 2}));
  EXPECT_EQ(requests_[0].spec_hash, run_.spec.Hash());
  EXPECT_EQ(requests_[0].learner_session, kLearnerSession);
  EXPECT_EQ(requests_[0].batch, 4u);
  EXPECT_EQ(requests_[0].after_steps, 0u);
  Answer(1);
  ASSERT_TRUE(source.Next(Now()));
  EXPECT_EQ(Asked(), (std::vector<uint64_t>{1, 2, 3})) << "asked before the batch is used";
}

TEST_F(BatchSourceTest, HandsOutBatchesInTheOrderOfRequests) {
  BatchSource& source = Make();
  source.Next(Now());
  Answer(2);
  EXPECT_FALSE(source.Next(Now())) << "the first is not here yet";
  Answer(1, 70);
  const auto first = source.Next(Now());
  ASSERT_TRUE(first);
  EXPECT_EQ(first->request, 1u);
  EXPECT_EQ(first->view.stored_steps, 70u);
  EXPECT_EQ(first->stored_records, 72u);
  EXPECT_EQ(first->unsampleable_steps, 7u);
  EXPECT_EQ(first->view.reward[3], 1.0f);
  const auto second = source.Next(Now());
  ASSERT_TRUE(second);
  EXPECT_EQ(second->request, 2u);
  EXPECT_EQ(second->view.reward[0], 2.0f);
}

TEST_F(BatchSourceTest, ABatchStaysWholeUntilTheNextIsAskedFor) {
  BatchSource& source = Make();
  source.Next(Now());
  Answer(1);
  const auto batch = source.Next(Now());
  Answer(2);
  Answer(3);
  Answer(4);  // not asked for yet: no buffer
  EXPECT_EQ(batch->view.reward[0], 1.0f);
  EXPECT_EQ(source.counters().unknown_parts, 1u);
}

TEST_F(BatchSourceTest, GoesOnWhereAFormerLearnerStopped) {
  Make(/*first_request=*/41).Next(Now());
  EXPECT_EQ(Asked(), (std::vector<uint64_t>{41, 42}));
}

TEST_F(BatchSourceTest, SendsTheSameRequestAgainWhenNothingComes) {
  BatchSource& source = Make(1, milliseconds(5));
  while (source.counters().resent_requests < 4) source.Next(Now() + milliseconds(5));
  ASSERT_GE(requests_.size(), 6u);
  std::map<uint64_t, int> times;
  for (const SampleRequest& request : requests_) {
    ++times[request.request];
    EXPECT_EQ(request.learner_session, kLearnerSession);
    EXPECT_EQ(request.batch, 4u);
  }
  EXPECT_EQ(times.size(), 2u);
  EXPECT_GE(times[1], 3);
  Answer(1);
  Answer(1);
  EXPECT_TRUE(source.Next(Now()));
  EXPECT_EQ(source.counters().duplicate_parts, 1u);
}

TEST_F(BatchSourceTest, DoesNotSendAgainWhatHasArrived) {
  BatchSource& source = Make(1, milliseconds(5));
  source.Next(Now());
  Answer(2);
  while (source.counters().resent_requests < 5) source.Next(Now() + milliseconds(5));
  EXPECT_EQ(std::ranges::count(Asked(), 2u), 1);
}

TEST_F(BatchSourceTest, TriesAgainSoonWhenARequestCouldNotBeSent) {
  accepting_ = false;
  BatchSource& source = Make();
  source.Next(Now());
  accepting_ = true;
  requests_.clear();
  const SteadyTime deadline = Now() + kLong;
  while (requests_.size() < 2 && Now() < deadline) source.Next(Now() + milliseconds(10));
  EXPECT_EQ(Asked(), (std::vector<uint64_t>{1, 2}));
  EXPECT_EQ(source.counters().resent_requests, 0u);
}

TEST_F(BatchSourceTest, RefusesBatchesOfAnotherSpecNamingBoth) {
  BatchSource& source = Make();
  source.Next(Now());
  spec_hash_ = 0xabcdef;
  Answer(1);
  try {
    source.Next(Now());
    FAIL() << "took a batch of another spec";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("0000000000abcdef"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(fmt::format("{:016x}", run_.spec.Hash())),
              std::string::npos)
        << e.what();
  }
}

// Request r brings the errors of batch r - 5, because there are two credits.
TEST_F(BatchSourceTest, ARequestBringsTheErrorsOfABatchAFixedNumberBefore) {
  run_.config.replay.priorities = "proportional";
  BatchSource& source = Make();
  source.Next(Now());
  for (uint64_t request = 1; request <= 9; ++request) {
    Answer(request);
    ASSERT_TRUE(source.Next(Now()));
    source.TakeErrors(
        {.request = request, .ids = {10 * request}, .errors = {static_cast<float>(request)}});
  }
  ASSERT_EQ(requests_.size(), 11u);
  for (const SampleRequest& request : requests_) {
    if (request.request <= 5) {
      EXPECT_TRUE(request.error_ids.empty() && request.errors.empty()) << request.request;
      continue;
    }
    EXPECT_EQ(request.error_ids, std::vector<uint64_t>{10 * (request.request - 5)});
    EXPECT_EQ(request.errors, std::vector<float>{static_cast<float>(request.request - 5)});
  }
}

TEST_F(BatchSourceTest, ARepeatedRequestBringsTheSameErrors) {
  run_.config.replay.priorities = "proportional";
  BatchSource& source = Make(/*first_request=*/1, milliseconds(5));
  source.Next(Now());
  for (uint64_t request = 1; request <= 5; ++request) {
    Answer(request);
    ASSERT_TRUE(source.Next(Now()));
    source.TakeErrors({.request = request, .ids = {request}, .errors = {2}});
  }
  const SteadyTime deadline = Now() + kLong;
  while (std::ranges::count(Asked(), 7u) < 3 && Now() < deadline) source.Next(Now());
  EXPECT_GE(std::ranges::count(Asked(), 7u), 3);
  for (const SampleRequest& request : requests_) {
    if (request.request != 7) continue;
    EXPECT_EQ(request.error_ids, std::vector<uint64_t>{2});
  }
}

// A restarted replay has lost the priorities, so its answer may have other samples of the same
// ring.
TEST_F(BatchSourceTest, PartsFromBeforeARepeatedRequestAreNotMixedWithLaterOnes) {
  for (const bool prioritised : {false, true}) {
    run_.config.replay.priorities = prioritised ? "lap" : "none";
    const BatchSchema schema = BatchSchemaOf(run_);
    BatchSource& source = Make(1, milliseconds(300));
    source.Next(Now());
    const std::vector<uint8_t> bytes(schema.total_bytes());
    const auto answer = [&](uint32_t part) {
      const uint64_t half = schema.total_bytes() / 2;
      BatchPart message{.spec_hash = spec_hash_,
                        .learner_session = kLearnerSession,
                        .request = 1,
                        .part = part,
                        .parts = 2,
                        .offset = part * half,
                        .total_bytes = schema.total_bytes(),
                        .payload = {bytes.data(), part == 0 ? half : schema.total_bytes() - half}};
      source.OnPart(message);
    };
    answer(0);
    const auto repeated = [&] { return std::ranges::count(Asked(), 1u); };
    const auto before = repeated();
    while (repeated() == before) source.Next(Now() + milliseconds(5));
    answer(1);
    EXPECT_EQ(source.Next(Now()).has_value(), !prioritised);
    answer(0);
    EXPECT_EQ(source.Next(Now()).has_value(), prioritised);
  }
}

TEST_F(BatchSourceTest, InLockstepWaitsForPhasesAndEndsWithTheRun) {
  run_.config.lockstep = true;
  run_.config.envs_per_actor = 1;
  run_.config.lockstep_steps = 4;     // one update per phase of four steps
  run_.config.env_steps = 8 + 3 * 4;  // three phases beyond the minimum
  BatchSource& source = Make();
  for (uint64_t update = 1; update <= 3; ++update) {
    source.Next(Now());
    Answer(update);
    ASSERT_TRUE(source.Next(Now()));
  }
  EXPECT_FALSE(source.Next(Now()));
  EXPECT_EQ(Asked(), (std::vector<uint64_t>{1, 2, 3}));
  EXPECT_EQ(requests_[0].after_steps, 12u);
  EXPECT_EQ(requests_[1].after_steps, 16u);
  EXPECT_EQ(requests_[2].after_steps, 20u);
}

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

// The receive thread answers while batches are read, each request with parts in turn.
TEST_F(BatchSourceTest, ReadsBatchesWhileAReceiveThreadFillsOthers) {
  constexpr uint64_t kBatches = 300;
  std::mutex mutex;
  std::condition_variable asked;
  std::deque<uint64_t> queue;
  source_.emplace(
      run_, kLearnerSession, 1,
      [&](const SampleRequest& request) {
        const std::lock_guard lock(mutex);
        queue.push_back(request.request);
        asked.notify_one();
        return true;
      },
      kLong);
  std::thread receiver([&] {
    for (uint64_t answered = 0; answered < kBatches; ++answered) {
      std::unique_lock lock(mutex);
      if (!asked.wait_for(lock, kLong, [&] { return !queue.empty(); })) return;
      const uint64_t request = queue.front();
      queue.pop_front();
      lock.unlock();
      Answer(request);
    }
  });
  for (uint64_t request = 1; request <= kBatches; ++request) {
    const auto batch = source_->Next(Now() + kLong);
    ASSERT_TRUE(batch);
    ASSERT_EQ(batch->request, request);
    for (const float reward : batch->view.reward) {
      ASSERT_EQ(reward, static_cast<float>(request));
    }
  }
  receiver.join();
}

}  // namespace
}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "replay_server/service/batch_sender.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>

#include "common/base/clock.h"

namespace shoal::replay {
namespace {

using std::chrono::seconds;

// Stores written messages; refuses a given number of writes.
class FakeWriter : public PartWriter {
 public:
  bool Write(const BatchPart& part) override {
    const std::lock_guard lock(mutex_);
    ++writes_;
    if (refusals_ != 0) {
      if (refusals_ > 0) --refusals_;
      return false;
    }
    parts_.push_back(part);
    bytes_.emplace_back(part.payload.begin(), part.payload.end());
    return true;
  }
  bool Write(const BatchSlot& slot) override {
    const std::lock_guard lock(mutex_);
    ++writes_;
    if (refusals_ != 0) {
      if (refusals_ > 0) --refusals_;
      return false;
    }
    slots_.push_back(slot);
    return true;
  }
  bool HasPartReader() override {
    ++looks_;
    return has_reader_;
  }
  bool HasSlotReader() override {
    ++slot_looks_;
    return has_slot_reader_;
  }
  // < 0: always.
  void Refuse(int times) {
    const std::lock_guard lock(mutex_);
    refusals_ = times;
  }

  std::mutex mutex_;
  int refusals_ = 0;
  std::atomic<int> writes_{0}, looks_{0}, slot_looks_{0};
  std::atomic<bool> has_reader_{true}, has_slot_reader_{true};
  std::vector<BatchPart> parts_;
  std::vector<BatchSlot> slots_;
  std::vector<std::vector<uint8_t>> bytes_;
};

class BatchSenderTest : public testing::Test {
 protected:
  static constexpr uint64_t kBatchBytes = 2 * kBulkPartBytes + 640;

  BatchSenderTest() { sender_.SetLearnerSession(7); }

  // Fills a free buffer with `value` and sends it as request `request` of session 7.
  void Send(uint64_t request, uint8_t value) {
    uint8_t* buffer = sender_.FreeBuffer();
    ASSERT_NE(buffer, nullptr);
    ASSERT_EQ(reinterpret_cast<uintptr_t>(buffer) % 64, 0u);
    std::memset(buffer, value, kBatchBytes);
    DrawnBatch batch;
    batch.request.learner_session = 7;
    batch.request.request = request;
    batch.stored_records = 100;
    batch.stored_steps = 90;
    batch.unsampleable_steps = 7;
    sender_.Send(batch, buffer);
  }
  // Waits until `count` batches have come to an end.
  bool WaitForEnds(int count) {
    std::unique_lock lock(mutex_);
    return freed_.wait_for(lock, seconds(20), [&] { return ends_ >= count; });
  }

  static BatchSlot Word(uint64_t request) {
    return {.spec_hash = 5, .learner_session = 7, .request = request, .address = {}, .slot = 2};
  }
  bool WaitForSent(uint64_t count) {
    const SteadyTime deadline = Now() + seconds(20);
    while (sender_.sent() < count && Now() < deadline) std::this_thread::yield();
    return sender_.sent() == count;
  }

  FakeWriter writer_;
  std::mutex mutex_;
  std::condition_variable freed_;
  int ends_ = 0;
  BatchSender sender_{5, kBatchBytes, 2, &writer_, [this] {
                        const std::lock_guard lock(mutex_);
                        ++ends_;
                        freed_.notify_all();
                      }};
};

TEST_F(BatchSenderTest, CutsABatchIntoPartsThatCoverIt) {
  Send(3, 0x5a);
  ASSERT_TRUE(WaitForEnds(1));
  ASSERT_EQ(writer_.parts_.size(), 3u);
  uint64_t offset = 0;
  for (uint32_t i = 0; i < 3; ++i) {
    const BatchPart& part = writer_.parts_[i];
    EXPECT_EQ(part.spec_hash, 5u);
    EXPECT_EQ(part.learner_session, 7u);
    EXPECT_EQ(part.request, 3u);
    EXPECT_EQ(part.part, i);
    EXPECT_EQ(part.parts, 3u);
    EXPECT_EQ(part.offset, offset);
    EXPECT_EQ(part.total_bytes, kBatchBytes);
    EXPECT_EQ(part.stored_records, 100u);
    EXPECT_EQ(part.stored_steps, 90u);
    EXPECT_EQ(part.unsampleable_steps, 7u);
    EXPECT_LT(writer_.bytes_[i].size(), 1'000'000u);
    EXPECT_EQ(writer_.bytes_[i], std::vector<uint8_t>(writer_.bytes_[i].size(), 0x5a));
    offset += writer_.bytes_[i].size();
  }
  EXPECT_EQ(offset, kBatchBytes);
  EXPECT_EQ(sender_.sent(), 1u);
}

TEST_F(BatchSenderTest, TriesAPartAgainThatWasNotTaken) {
  writer_.Refuse(4);
  Send(1, 1);
  ASSERT_TRUE(WaitForEnds(1));
  EXPECT_EQ(writer_.parts_.size(), 3u);
  EXPECT_EQ(writer_.writes_, 7);
}

TEST_F(BatchSenderTest, HasAsManyBatchesUnderWayAsBuffers) {
  writer_.Refuse(-1);
  Send(1, 1);
  Send(2, 2);
  EXPECT_EQ(sender_.FreeBuffer(), nullptr);
  writer_.Refuse(0);
  ASSERT_TRUE(WaitForEnds(2));
  EXPECT_NE(sender_.FreeBuffer(), nullptr);
  ASSERT_EQ(writer_.parts_.size(), 6u);
  EXPECT_EQ(writer_.parts_[2].request, 1u);
  EXPECT_EQ(writer_.parts_[3].request, 2u);
}

TEST_F(BatchSenderTest, GivesUpTheBatchesOfAReplacedLearnerSession) {
  writer_.Refuse(-1);
  Send(1, 1);
  Send(2, 2);
  const SteadyTime start = Now();
  sender_.SetLearnerSession(8);
  ASSERT_TRUE(WaitForEnds(2));
  EXPECT_LT(Now() - start, BatchSender::kPartDeadline) << "at once, not for want of progress";
  EXPECT_TRUE(writer_.parts_.empty());
  EXPECT_EQ(sender_.given_up(), 2u);
}

TEST_F(BatchSenderTest, WaitsForTheLearnersReaderBeforeTheFirstPart) {
  writer_.has_reader_ = false;
  Send(1, 1);
  const SteadyTime deadline = Now() + seconds(20);
  while (writer_.looks_ < 2 && Now() < deadline) std::this_thread::yield();
  EXPECT_EQ(writer_.writes_, 0);
  writer_.has_reader_ = true;
  ASSERT_TRUE(WaitForEnds(1));
  EXPECT_EQ(writer_.parts_.size(), 3u);
}

TEST_F(BatchSenderTest, SaysThatASlotIsFull) {
  sender_.Send(Word(3));
  ASSERT_TRUE(WaitForSent(1));
  ASSERT_EQ(writer_.slots_.size(), 1u);
  EXPECT_EQ(writer_.slots_[0].request, 3u);
  EXPECT_EQ(writer_.slots_[0].slot, 2u);
  EXPECT_TRUE(writer_.parts_.empty());
}

TEST_F(BatchSenderTest, SaysOnceWhatWaitsToBeSaid) {
  writer_.has_slot_reader_ = false;
  sender_.Send(Word(1));
  const SteadyTime deadline = Now() + seconds(20);
  while (writer_.slot_looks_ == 0 && Now() < deadline) std::this_thread::yield();
  for (int again = 0; again < 3; ++again) sender_.Send(Word(2));
  sender_.Send(Word(3));
  writer_.has_slot_reader_ = true;
  ASSERT_TRUE(WaitForSent(3));
  ASSERT_EQ(writer_.slots_.size(), 3u);
  EXPECT_EQ(writer_.slots_[1].request, 2u);
  EXPECT_EQ(writer_.slots_[2].request, 3u);
}

TEST_F(BatchSenderTest, GivesUpTheSlotsOfAReplacedLearnerSession) {
  writer_.Refuse(-1);
  sender_.Send(Word(1));
  sender_.SetLearnerSession(8);
  const SteadyTime deadline = Now() + seconds(20);
  while (sender_.given_up() < 1 && Now() < deadline) std::this_thread::yield();
  EXPECT_EQ(sender_.given_up(), 1u);
  EXPECT_TRUE(writer_.slots_.empty());
}

TEST_F(BatchSenderTest, EndsInTheMiddleOfABatch) {
  writer_.Refuse(-1);
  Send(1, 1);
  const SteadyTime deadline = Now() + seconds(20);
  while (writer_.writes_ == 0 && Now() < deadline) std::this_thread::yield();
  EXPECT_GT(writer_.writes_, 0);
}  // the destructor does not hang

}  // namespace
}  // namespace shoal::replay

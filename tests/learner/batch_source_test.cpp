// SPDX-License-Identifier: Apache-2.0
#include "learner/batch_source.h"

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "common/base/error.h"
#include "common/config/lockstep.h"
#include "tests/learner/batch_source_fixture.h"

namespace shoal::learner {
namespace {

using std::chrono::milliseconds;

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

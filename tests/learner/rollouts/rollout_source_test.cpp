// SPDX-License-Identifier: Apache-2.0
#include "learner/rollouts/rollout_source.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <map>

#include "tests/learner/rollouts/actor_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::learner {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

class RolloutSourceTest : public testing::Test {
 protected:
  RolloutSource& Make(int actors, double rollout_deadline) {
    RunConfig run = PpoRun(actors);
    run.config.ppo.rollout_deadline = rollout_deadline;
    run.config.learner.batch = batch_;
    source_.emplace(run, folder_.path() / "run", kFirst.session, kFirst.update,
                    [this](const CreditsMessage& message) { Keep(message); });
    return *source_;
  }
  // Runs on the serving thread: stores the account at the time of each message.
  void Keep(const CreditsMessage& message) {
    const RunAccount account = ReadAccountBefore(folder_.path() / "run");
    const MutexLock lock(mutex_);
    for (const Credit& credit : message.credits) {
      told_[credit.actor] = credit.stored;
      uint64_t written = 0;
      for (const SessionCounters& session : account.sessions) {
        if (session.actor == credit.actor) written = session.highest;
      }
      if (credit.stored > written) ++told_too_early_;
    }
    changed_.NotifyAll();
  }
  bool WaitUntilTold(uint32_t actor, uint64_t stored, milliseconds most) {
    const SteadyTime deadline = Now() + most;
    const MutexLock lock(mutex_);
    while (told_[actor] < stored) {
      if (!changed_.WaitUntil(mutex_, deadline)) break;
    }
    return told_[actor] >= stored;
  }
  int ToldTooEarly() {
    const MutexLock lock(mutex_);
    return told_too_early_;
  }

  RolloutSourceTest() { std::filesystem::create_directory(folder_.path() / "run"); }

  const TemporaryFolder folder_;
  int batch_ = 3;  // a rollout's steps
  Mutex mutex_;
  ConditionVariable changed_;
  std::map<uint32_t, uint64_t> told_ SHOAL_GUARDED_BY(mutex_);
  int told_too_early_ SHOAL_GUARDED_BY(mutex_) = 0;
  std::optional<RolloutSource> source_;
  ActorScript a_{PpoSpec(), 0, 10}, b_{PpoSpec(), 1, 11};
};

TEST_F(RolloutSourceTest, NothingIsAcknowledgedThatTheAccountDoesNotSay) {
  Make(2, 30);
  for (uint32_t episode = 0; episode < 5; ++episode) {
    a_.PlayThree(0, episode);
    source_->OnChunk(a_.Chunk());
    ASSERT_TRUE(WaitUntilTold(0, 4 * (episode + 1), seconds(20)));
  }
  EXPECT_EQ(ToldTooEarly(), 0);
}

TEST_F(RolloutSourceTest, WithoutAFileForTheAccountTrainingGoesOn) {
  Make(2, 30);
  a_.PlayThree(0, 0);
  source_->OnChunk(a_.Chunk());
  ASSERT_TRUE(WaitUntilTold(0, 4, seconds(20)));
  std::filesystem::remove_all(folder_.path() / "run");
  a_.PlayThree(0, 1);
  source_->OnChunk(a_.Chunk());
  EXPECT_TRUE(WaitUntilTold(0, 8, seconds(20))) << "a full disk does not stop the actors";
  std::filesystem::create_directory(folder_.path() / "run");
  a_.PlayThree(0, 2);
  source_->OnChunk(a_.Chunk());
  EXPECT_TRUE(WaitUntilTold(0, 12, seconds(20)));
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "run/accounting.json"))
      << "written again once there is room";
}

TEST_F(RolloutSourceTest, HandsARolloutOfEveryEnvironmentOutAndAwaitsTheNextVersion) {
  Make(2, 30);
  a_.PlayThree(0, 0);
  b_.PlayThree(1, 0);
  source_->OnChunk(a_.Chunk());
  EXPECT_FALSE(source_->Next(Now() + milliseconds(100))) << "one of two is not there";
  source_->OnChunk(b_.Chunk());
  const auto batch = source_->Next(Now() + seconds(20));
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->view.reward.size(), 6u);
  EXPECT_EQ(batch->request, 1u);
  EXPECT_EQ(batch->view.stored_steps, 6u);
  EXPECT_FALSE(source_->Next(Now() + milliseconds(20)));
  a_.PlayThree(0, 1, {100, 1});
  b_.PlayThree(1, 1, {100, 1});
  source_->OnChunk(a_.Chunk());
  source_->OnChunk(b_.Chunk());
  const auto second = source_->Next(Now() + seconds(20));
  ASSERT_TRUE(second);
  EXPECT_EQ(second->request, 2u);
  EXPECT_EQ(second->view.weights_update[0], 1u);
}

TEST_F(RolloutSourceTest, AfterTheDeadlineHalfOfTheRolloutsDoAndAreSaidToBeLate) {
  Make(2, 0.2);
  a_.PlayThree(0, 0);
  source_->OnChunk(a_.Chunk());
  const SteadyTime start = Now();
  std::optional<Batch> batch;
  while (!batch && Now() - start < seconds(20)) batch = source_->Next(Now() + milliseconds(20));
  ASSERT_TRUE(batch);
  EXPECT_GE(Now() - start, milliseconds(150));
  EXPECT_EQ(batch->view.reward.size(), 3u);
  EXPECT_EQ(source_->counters().rollouts->late, 1u);
}

TEST_F(RolloutSourceTest, LessThanHalfAreWaitedForThreeTimesAsLong) {
  Make(3, 0.2);
  a_.PlayThree(0, 0);
  source_->OnChunk(a_.Chunk());
  const SteadyTime start = Now();
  std::optional<Batch> batch;
  while (!batch && Now() - start < seconds(20)) batch = source_->Next(Now() + milliseconds(20));
  ASSERT_TRUE(batch);
  EXPECT_GE(Now() - start, milliseconds(550));
  EXPECT_EQ(batch->view.reward.size(), 3u);
}

TEST_F(RolloutSourceTest, RolloutsThatMakeNoMinibatchAreNotHandedOut) {
  RunConfig run = PpoRun(2);
  run.config.ppo.rollout_deadline = 0.1;
  run.config.learner.batch = 6;
  source_.emplace(run, folder_.path() / "run", kFirst.session, kFirst.update,
                  [this](const CreditsMessage& message) { Keep(message); });
  a_.PlayThree(0, 0);
  source_->OnChunk(a_.Chunk());
  ASSERT_TRUE(WaitUntilTold(0, 4, seconds(20)));
  EXPECT_FALSE(source_->Next(Now() + milliseconds(600)));
  b_.PlayThree(1, 0);
  source_->OnChunk(b_.Chunk());
  EXPECT_TRUE(source_->Next(Now() + seconds(20)));
}

TEST_F(RolloutSourceTest, LessThanHalfAreWaitedForBeyondTheDeadline) {
  Make(3, 4);
  a_.PlayThree(0, 0);
  source_->OnChunk(a_.Chunk());
  ASSERT_TRUE(WaitUntilTold(0, 4, seconds(20)));
  EXPECT_FALSE(source_->Next(Now() + milliseconds(400)));
  source_->SetActors(2);  // waits for the missing half until the deadline
  EXPECT_TRUE(source_->Next(Now() + seconds(6))) << "sooner than after three times the deadline";
}

TEST_F(RolloutSourceTest, LeavesATrueAccount) {
  Make(2, 30);
  a_.PlayThree(0, 0);
  b_.PlayThree(1, 0);
  source_->OnChunk(a_.Chunk());
  source_->OnChunk(b_.Chunk());
  ASSERT_TRUE(source_->Next(Now() + seconds(20)));
  a_.PlayThree(0, 1);
  source_->OnChunk(a_.Chunk());
  source_.reset();
  const RunAccount account = ReadAccountBefore(folder_.path() / "run");
  EXPECT_EQ(account.stored_steps, 9u);
  ASSERT_EQ(account.sessions.size(), 2u);
  EXPECT_EQ(account.sessions[0].highest, 8u);
  EXPECT_EQ(account.sessions[0].stored(), 4u);
  EXPECT_EQ(account.sessions[0].discarded, 4u);
  EXPECT_EQ(account.sessions[1].discarded, 0u);
}

}  // namespace
}  // namespace shoal::learner

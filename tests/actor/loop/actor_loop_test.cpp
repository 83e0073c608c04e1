// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/actor_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "common/base/error.h"
#include "tests/actor/loop/rollout_parts.h"
#include "tests/actor/sending/fake_link.h"

namespace shoal::actor {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using End = ActorLoop::End;

constexpr int kEnvs = 2;
constexpr uint64_t kSession = 10;
constexpr uint64_t kWindow = 24;

struct FakeControl final : RunControl {
  RunState state() override { return run_state; }
  bool CoordinatorLost(SteadyTime) override { return lost; }
  bool StopRequested() override { return requests > 0; }
  int StopRequests() override { return requests; }
  RunState run_state = RunState::kRunning;
  bool lost = false;
  int requests = 0;
};

struct FakeWeights final : WeightsSource {
  std::optional<ReceivedWeights> TryTake() override { return std::exchange(next, std::nullopt); }
  std::optional<ReceivedWeights> next;
};

// The loop with a replay, a learner, a coordinator and a clock that the test simulates. While
// `storing_`, the replay stores sent records and acknowledges them at the actor's next poll.
class ActorLoopTest : public testing::Test {
 protected:
  ActorLoopTest() {
    link_.answer = [this] {
      if (!storing_ || link_.sent.empty() || link_.sent.back().last == stored_) return;
      stored_ = link_.sent.back().last;
      link_.credits = {{.replay_session = 1,
                        .session = kSession,
                        .stored = stored_,
                        .allowed = stored_ + kWindow,
                        .spec_hash = parts_.spec.Hash()}};
    };
  }

  // Runs until `turns` progress calls were made while the loop was still stepping or waiting; then
  // the run drains. `each`, if any, is asked at every call.
  End Run(Pace& pace, int turns, const std::function<void(int turn)>& each = {}) {
    ActorLoop loop({.rollout = parts_.rollout,
                    .selector = parts_.selector,
                    .sender = sender_,
                    .weights = weights_,
                    .pace = pace,
                    .control = control_,
                    .now = clock_.Reader()});
    return loop.Run([this, turns, each, turn = 0](const char* state, bool last) mutable {
      states_.emplace_back(state);
      EXPECT_EQ(last, states_.back() == "stopping");
      ++turn;
      if (each) each(turn);
      if (turn == turns) control_.run_state = RunState::kDraining;
    });
  }
  void OfferWeights(WeightsVersion version) {
    weights_.next = ConstantPolicy(parts_.config.network, parts_.spec, version, 0, 0);
  }

  // The weights update by which each record sent was acted, in order of sequence.
  std::map<uint64_t, uint64_t> UpdateOfRecords() const {
    std::map<uint64_t, uint64_t> updates;
    const auto record_bytes = static_cast<size_t>(RecordLayout(parts_.spec).record_bytes());
    for (const FakeLink::SentChunk& chunk : link_.sent) {
      for (uint64_t i = 0; i <= chunk.last - chunk.first; ++i) {
        RecordHeader header;
        std::memcpy(&header, chunk.bytes.data() + i * record_bytes, sizeof header);
        updates[header.sequence] = header.weights_update;
      }
    }
    return updates;
  }

  const TemporaryFolder run_;
  FakeClock clock_;
  FakeLink link_{clock_};
  ChunkWindow window_{{.spec_hash = CountingEnvironment().spec().Hash(),
                       .session = kSession,
                       .record_bytes = RecordLayout(CountingEnvironment().spec()).record_bytes(),
                       .chunk_records = 6,
                       .chunks = 5,
                       .first_records = kWindow}};
  RolloutParts parts_{run_.path(), window_, kEnvs, /*first_env=*/0, kSession};
  ChunkSender sender_{
      window_,
      link_,
      {.spec_hash = parts_.spec.Hash(), .flush_after = milliseconds(100), .now = clock_.Reader()}};
  FakeWeights weights_;
  FakeControl control_;
  bool storing_ = true;
  uint64_t stored_ = 0;
  std::vector<std::string> states_;
};

TEST_F(ActorLoopTest, StepsUntilTheRunDrainsThenHasEverythingStored) {
  FreePace pace;
  EXPECT_EQ(Run(pace, 10), End::kAllStored);
  EXPECT_EQ(parts_.rollout.vector_steps(), 10);
  EXPECT_EQ(window_.Outstanding(), 0u);
  EXPECT_EQ(stored_, parts_.made.made());
  EXPECT_EQ(UpdateOfRecords().size(), parts_.made.made()) << "every record was sent";
  EXPECT_EQ(states_.front(), "running");
  EXPECT_EQ(states_.back(), "stopping");
  EXPECT_EQ(window_.resent_records(), 0u);
}

TEST_F(ActorLoopTest, TakesTheNewestWeightsBetweenSteps) {
  FreePace pace;
  Run(pace, 6, [&](int turn) {
    if (turn == 3) OfferWeights({1, 20});
  });
  const auto updates = UpdateOfRecords();
  EXPECT_EQ(updates.at(1), 0u);
  EXPECT_EQ(updates.rbegin()->second, 20u);
  EXPECT_EQ(parts_.selector.version().update, 20u);
}

TEST_F(ActorLoopTest, WithoutCreditItLooksForItPatientlyAndGoesOn) {
  storing_ = false;
  FreePace pace;
  const SteadyTime start = clock_.now;
  int64_t steps_when_full = 0;
  Run(pace, 200, [&](int turn) {
    if (turn == 100) steps_when_full = parts_.rollout.vector_steps();
    if (turn == 150) storing_ = true;
  });
  // Three records are left; two environments may each need a reset and a step.
  EXPECT_LE(steps_when_full, int64_t{kWindow} / kEnvs);
  EXPECT_GT(window_.stored(), kWindow) << "went on when credit came";
  EXPECT_GE(clock_.now - start, 80 * ActorLoop::kBlockedWait) << "it does not spin";
  EXPECT_LE(clock_.now - start, 200 * ActorLoop::kBlockedWait);
}

TEST_F(ActorLoopTest, AFullWindowSendsItsOpenChunkToo) {
  storing_ = false;
  FreePace pace;
  Run(pace, 50, [&](int turn) {
    if (turn == 49) control_.requests = 1;
    if (turn == 50) control_.requests = 2;
  });
  uint64_t sent = 0;
  for (const auto& chunk : link_.sent) sent = std::max(sent, chunk.last);
  EXPECT_EQ(sent, parts_.made.made());
}

TEST_F(ActorLoopTest, ADrainSendsAgainWhatWasLost) {
  FreePace pace;
  const auto end = Run(pace, 10, [&](int turn) {
    if (turn == 10) {
      storing_ = false;
      link_.credits.clear();
    }
    // The restarted replay has lost all records, and stores those sent from now on.
    if (states_.back() == "draining" && window_.resent_records() > 0) storing_ = true;
  });
  EXPECT_EQ(end, End::kAllStored);
  EXPECT_GT(window_.resent_records(), 0u);
  EXPECT_EQ(window_.Outstanding(), 0u);
}

TEST_F(ActorLoopTest, ADrainGivesUpAtItsDeadline) {
  storing_ = false;
  FreePace pace;
  SteadyTime drain_began;
  const auto end = Run(pace, 3, [&](int turn) {
    if (turn == 3) drain_began = clock_.now;
  });
  EXPECT_EQ(end, End::kUnstored);
  EXPECT_GE(clock_.now - drain_began, ActorLoop::kDrainDeadline);
  EXPECT_LE(clock_.now - drain_began, ActorLoop::kDrainDeadline + ActorLoop::kBlockedWait);
  EXPECT_EQ(states_.back(), "stopping") << "the last report is sent all the same";
}

TEST_F(ActorLoopTest, ASignalDrainsAndASecondOneEndsTheDrain) {
  storing_ = false;
  FreePace pace;
  SteadyTime drain_began;
  const auto end = Run(pace, 1000, [&](int turn) {
    if (turn == 3) {
      control_.requests = 1;
      drain_began = clock_.now;
    }
    if (turn == 20) control_.requests = 2;
  });
  EXPECT_EQ(end, End::kUnstored);
  EXPECT_EQ(states_[18], "draining");
  EXPECT_LE(clock_.now - drain_began, 20 * ActorLoop::kBlockedWait);
}

TEST_F(ActorLoopTest, ALostCoordinatorEndsItAfterADrain) {
  FreePace pace;
  const auto end = Run(pace, 1000, [&](int turn) {
    if (turn == 5) control_.lost = true;
  });
  EXPECT_EQ(end, End::kCoordinatorLost);
  EXPECT_EQ(window_.Outstanding(), 0u);
  EXPECT_EQ(parts_.rollout.vector_steps(), 5);
}

// Phases end after 4, 6, 8, ... vector steps.
Config Lockstep() {
  Config config = SmallConfig(kEnvs);
  config.lockstep = true;
  config.lockstep_steps = 2;
  config.env_steps = 1000;
  config.replay.min_size = 8;
  config.replay.samples_per_insert = Schedule::Constant(0);
  return config;
}

TEST_F(ActorLoopTest, InLockstepItHasAPhaseStoredAndAwaitsItsWeights) {
  LockstepPace pace(Lockstep(), 0);
  std::vector<int64_t> waited_at;
  uint64_t update = 0;
  EXPECT_EQ(Run(pace, 60,
                [&](int) {
                  if (states_.back() != "blocked") return;
                  waited_at.push_back(parts_.rollout.vector_steps());
                  if (window_.Outstanding() == 0 && !weights_.next) OfferWeights({1, ++update});
                }),
            End::kAllStored);
  ASSERT_GT(update, 3u) << "whole phases are stored though chunks are partial";
  const std::set<int64_t> ends(waited_at.begin(), waited_at.end());
  EXPECT_EQ(std::vector<int64_t>(ends.begin(), std::next(ends.begin(), 3)),
            (std::vector<int64_t>{6, 8, 10}));
  // Each phase is played by the update of the one before: 2 * kEnvs steps of each, and resets.
  std::map<uint64_t, int> steps;
  std::set<uint64_t> in_order;
  for (const auto& [sequence, by] : UpdateOfRecords()) {
    ++steps[by];
    EXPECT_GE(by, in_order.empty() ? 0 : *in_order.rbegin()) << sequence;
    in_order.insert(by);
  }
  EXPECT_GE(steps[1], 2 * kEnvs);
  EXPECT_LE(steps[1], 4 * kEnvs);
}

TEST_F(ActorLoopTest, InLockstepWeightsThatNeverComeAreAnErrorNamingThem) {
  LockstepPace pace(Lockstep(), 0);
  const SteadyTime start = clock_.now;
  try {
    Run(pace, 1'000'000);
    FAIL() << "went on without weights";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("lockstep: no weights of update 1 within 120 s"));
  }
  EXPECT_GE(clock_.now - start, FreePace().patience());
  EXPECT_LE(clock_.now - start, FreePace().patience() + seconds(1));
}

TEST_F(ActorLoopTest, TheRunsEndEndsTheWaitForWeights) {
  LockstepPace pace(Lockstep(), 0);
  EXPECT_EQ(Run(pace, 30), End::kAllStored);
  EXPECT_EQ(parts_.rollout.vector_steps(), 6);
}

TEST_F(ActorLoopTest, RolloutsOfAFixedLengthAreEachOfOneVersion) {
  VersionPace pace(/*vector_steps=*/3);
  uint64_t update = 0;
  Run(pace, 60, [&](int turn) {
    if (turn % 4 == 0) OfferWeights({1, ++update});  // more often than rollouts end
  });
  std::map<uint64_t, int> records;
  for (const auto& [sequence, by] : UpdateOfRecords()) ++records[by];
  EXPECT_EQ(records.count(0), 0u) << "nothing was played before the first version";
  ASSERT_GT(records.size(), 3u);
  // Episodes are as long as rollouts: a reset and three steps of each environment.
  std::vector<int> counts;
  for (const auto& [by, count] : records) counts.push_back(count);
  counts.pop_back();  // the last one was cut short
  EXPECT_THAT(counts, Each(kEnvs * (1 + 3)));
}

}  // namespace
}  // namespace shoal::actor

// SPDX-License-Identifier: Apache-2.0
// The server is killed at random times. Acknowledged records must be present, and all later
// behaviour must equal that of an uninterrupted server.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "common/base/clock.h"
#include "replay_server/core/replay_core.h"
#include "tests/replay_server/oracle.h"
#include "tests/replay_server/record_script.h"
#include "tests/support/temporary_folder.h"

namespace shoal::replay {
namespace {

constexpr uint64_t kCrashCapacity = 128;
constexpr uint32_t kActors = 2;
constexpr int kRounds = 25;
constexpr uint64_t kPerRound = 300;  // records of an actor at most
constexpr uint64_t kRecords = kRounds * kPerRound;

// Sequences acknowledged per actor, shared with the child.
struct Acknowledged {
  std::atomic<uint64_t> highest[kActors];
};
static_assert(std::atomic<uint64_t>::is_always_lock_free);

class CrashTest : public testing::Test {
 protected:
  CrashTest() : run_(TinyRun(2, kCrashCapacity)) {
    run_.spec = TinySpec(2, 40, 50);  // larger records: more instants inside a copy
    run_.config.replay.storage = "file";
    void* shared = mmap(nullptr, sizeof(Acknowledged), PROT_READ | PROT_WRITE,
                        MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    acknowledged_ = new (shared) Acknowledged{};
    for (uint32_t actor = 0; actor < kActors; ++actor) {
      scripts_.emplace_back(run_.spec, actor, 10 + actor, 3);
    }
    // Every eleventh record is malformed, so that counters other than `stored` move as well.
    for (RecordScript& script : scripts_) {
      for (uint64_t sequence = 11; sequence <= kRecords; sequence += 11) script.Spoil(sequence);
    }
  }
  ~CrashTest() override { munmap(acknowledged_, sizeof(Acknowledged)); }

  // The child: opens the ring as it is and stores until killed (or long enough).
  [[noreturn]] void StoreForEver() {
    ReplayCore core(run_, folder_.path(), 1);
    uint64_t next[kActors], last[kActors];
    for (uint32_t actor = 0; actor < kActors; ++actor) {
      next[actor] = Highest(core, actor) + 1;
      last[actor] = Highest(core, actor) + kPerRound;
    }
    for (uint32_t turn = 0;; ++turn) {
      const uint32_t actor = turn % kActors, count = 1 + turn % 5;
      if (next[actor] + count > last[actor]) pause();
      core.TakeChunk(scripts_[actor].Chunk(next[actor], count));
      next[actor] += count;
      acknowledged_->highest[actor].store(Highest(core, actor));
    }
  }

  static uint64_t Highest(const ReplayCore& core, uint32_t actor) {
    const auto i = core.sessions().Find(actor, 10 + actor);
    return i ? core.sessions().at(*i).highest : 0;
  }

  // Kills a child at some random instant after it has acknowledged some more.
  void RunAndKill() {
    const uint64_t before = acknowledged_->highest[1];
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) StoreForEver();
    const SteadyTime deadline = Now() + std::chrono::seconds(20);
    const uint64_t enough = before + 1 + random_.Below(100);
    while (acknowledged_->highest[1] < enough && Now() < deadline) std::this_thread::yield();
    for (uint64_t spin = random_.Below(20'000); spin > 0; --spin) {
      std::atomic_signal_fence(std::memory_order_seq_cst);
    }
    kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself with " << WEXITSTATUS(status);
    ASSERT_GE(acknowledged_->highest[1], enough);
  }

  // Replays the whole history into the oracle, in the order in which the ring has stored it.
  void CheckRecovered() {
    const ReplayCore core(run_, folder_.path(), 2);
    const RecordLayout layout(run_.spec);
    for (uint32_t actor = 0; actor < kActors; ++actor) {
      ASSERT_GE(Highest(core, actor), acknowledged_->highest[actor]);
      const SessionCounters counters = core.sessions().at(*core.sessions().Find(actor, 10 + actor));
      Oracle alone{.capacity = kRecords, .stack = 2};
      Oracle::Counts counts;
      for (uint64_t sequence = 1; sequence <= counters.highest; ++sequence) {
        alone.Take(layout, actor, 10 + actor, scripts_[actor].At(sequence), &counts);
      }
      ASSERT_EQ(counters.stored(), counts.stored);
      ASSERT_EQ(counters.rejected, counts.rejected);
      ASSERT_EQ(counters.after_gap, counts.after_gap);
    }
    CheckRing(core);
  }

  void CheckRing(const ReplayCore& core) {
    const Ring& ring = core.ring();
    const auto bytes = static_cast<size_t>(ring.layout().record_bytes());
    uint64_t steps = 0;
    for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
      const uint8_t* record = ring.Record(id);
      ASSERT_EQ(std::vector<uint8_t>(record, record + bytes),
                scripts_[ring.Slot(id).actor].At(ring.Header(id).sequence));
      steps += core.index().Sampleable(id) ? 1 : 0;
    }
    ASSERT_GE(ring.last_id() - ring.oldest_id() + 1, std::min(ring.last_id(), kCrashCapacity - 1));
    ASSERT_EQ(core.index().sampleable(), steps);
  }

  RunConfig run_;
  TemporaryFolder folder_;
  Acknowledged* acknowledged_;
  std::vector<RecordScript> scripts_;
  Random random_{5};
};

TEST_F(CrashTest, NothingAcknowledgedIsLostWhenKilledAtAnyInstant) {
  for (int round = 0; round < kRounds; ++round) {
    RunAndKill();
    ASSERT_FALSE(HasFatalFailure());
    CheckRecovered();
    ASSERT_FALSE(HasFatalFailure()) << "round " << round;
  }
}

}  // namespace
}  // namespace shoal::replay

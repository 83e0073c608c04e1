// SPDX-License-Identifier: Apache-2.0
// Many writers and readers at once, some of which come and go.
#include "common/link/local_exchange.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "common/link/local_network.h"
#include "common/link/reader.h"
#include "common/link/writer.h"

namespace shoal::link {
namespace {

constexpr std::chrono::seconds kStressDeadline{30};

// Checks the chunks of several actors as they arrive: each whole, each actor's in order.
class ChunkCheck {
 public:
  // On one thread.
  void Add(const TransitionChunk& chunk) {
    uint64_t& last = last_[chunk.actor];
    if (chunk.first_sequence <= last) ++disorder_;
    if (chunk.first_sequence != last + 1) ++gaps_;
    last = chunk.first_sequence;
    // All bytes are that of the number.
    const std::span<const uint8_t> bytes = chunk.payload;
    if (bytes.front() != static_cast<uint8_t>(chunk.first_sequence) ||
        std::memcmp(bytes.data(), bytes.data() + 1, bytes.size() - 1) != 0) {
      ++damaged_;
    }
    ++count_;
  }

  uint64_t count() const { return count_; }
  uint64_t disorder() const { return disorder_; }
  uint64_t gaps() const { return gaps_; }
  uint64_t damaged() const { return damaged_; }

 private:
  std::map<uint32_t, uint64_t> last_;
  std::atomic<uint64_t> count_{0}, disorder_{0}, gaps_{0}, damaged_{0};
};

constexpr uint32_t kActors = 4;
constexpr uint64_t kChunks = 250;

// An actor: sends kChunks chunks and as many reports, and counts the credits that arrive.
void Send(LocalNetwork& network, uint32_t id, std::atomic<uint64_t>* credits) {
  constexpr size_t kBytes = 100'000;
  const std::unique_ptr<Hub> hub = network.Join(Role::kActor);
  Writer<TransitionChunk> chunks(*hub);
  Writer<ActorMetrics> metrics(*hub);
  const Reader<CreditsMessage> credit_reader(*hub, [&](const CreditsMessage&) { ++*credits; });
  std::vector<uint8_t> payload(kBytes);
  const SteadyTime start = Now();
  for (uint64_t n = 1; n <= kChunks && Now() - start < kStressDeadline;) {
    std::memset(payload.data(), static_cast<uint8_t>(n), payload.size());
    TransitionChunk chunk;
    chunk.actor = id;
    chunk.first_sequence = n;
    chunk.payload = payload;
    if (chunks.Write(chunk)) ++n;
    ActorMetrics report;
    report.id = id;
    metrics.Write(report);
  }
  EXPECT_TRUE(chunks.WaitForAcks(kStressDeadline));
  EXPECT_TRUE(metrics.WaitForAcks(kStressDeadline));
}

// Makes and destroys hubs, readers and writers.
void ComeAndGo(LocalNetwork& network, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const std::unique_ptr<Hub> hub = network.Join(Role::kLearner);
    ChunkCheck check;
    const Writer<CreditsMessage> writer(*hub);
    std::atomic<bool> alive{true};
    {
      const Reader<TransitionChunk> reader(*hub, [&](const TransitionChunk& chunk) {
        EXPECT_TRUE(alive);
        check.Add(chunk);
      });
      EXPECT_GE(writer.Matched(), 0);
      EXPECT_GE(reader.Matched(), 0);
      for (int i = 0; i < 50; ++i) std::this_thread::yield();
    }
    alive = false;
    EXPECT_EQ(check.disorder(), 0u);
    EXPECT_EQ(check.damaged(), 0u);
  }
}

TEST(LocalExchange, ManyWritersAndReadersLoseAndMixNothing) {
  LocalNetwork network;
  const auto replay = network.Join(Role::kReplay), learner = network.Join(Role::kLearner),
             coordinator = network.Join(Role::kCoordinator);
  ChunkCheck at_replay, at_learner;
  std::atomic<uint64_t> reports{0}, credits{0};
  {
    Writer<CreditsMessage> credit_writer(*replay);
    const Reader<TransitionChunk> replay_chunks(*replay, [&](const TransitionChunk& chunk) {
      at_replay.Add(chunk);
      credit_writer.Write({});  // a callback may write what never waits
    });
    const Reader<TransitionChunk> learner_chunks(
        *learner, [&](const TransitionChunk& chunk) { at_learner.Add(chunk); });
    const Reader<ActorMetrics> metrics(*coordinator, [&](const ActorMetrics&) { ++reports; });
    std::vector<std::jthread> actors;
    for (uint32_t id = 0; id < kActors; ++id) {
      actors.emplace_back([&, id] { Send(network, id, &credits); });
    }
    const std::jthread churn([&](const std::stop_token& stop) { ComeAndGo(network, stop); });
    actors.clear();
  }
  for (const ChunkCheck* check : {&at_replay, &at_learner}) {
    EXPECT_EQ(check->count(), kActors * kChunks);
    EXPECT_EQ(check->gaps(), 0u);
    EXPECT_EQ(check->damaged(), 0u);
  }
  EXPECT_GT(reports, 0u);
  EXPECT_GT(credits, 0u);
}

}  // namespace
}  // namespace shoal::link

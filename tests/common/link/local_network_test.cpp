// SPDX-License-Identifier: Apache-2.0
// Tests of the promises of local_network.h beyond the contract (contract_fixture.h).
#include "common/link/local_network.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/base/clock.h"
#include "common/link/reader.h"
#include "common/link/writer.h"

namespace shoal::link {
namespace {

using std::chrono::seconds;

constexpr seconds kDeadline{20};

// The samples that callbacks saw. They wait while it is shut.
class Gate {
 public:
  void Shut() {
    const std::lock_guard lock(mutex_);
    open_ = false;
  }
  void Open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  // In a callback.
  void Pass(uint64_t number) {
    std::unique_lock lock(mutex_);
    ++arrived_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return open_; });
    passed_.push_back(number);
    threads_.insert(std::this_thread::get_id());
    changed_.notify_all();
  }
  bool WaitForArrived(uint64_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kDeadline, [&] { return arrived_ >= count; });
  }
  std::vector<uint64_t> WaitForPassed(size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kDeadline, [&] { return passed_.size() >= count; });
    return passed_;
  }
  std::set<std::thread::id> threads() {
    const std::lock_guard lock(mutex_);
    return threads_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = true;
  uint64_t arrived_ = 0;
  std::vector<uint64_t> passed_;
  std::set<std::thread::id> threads_;
};

using Numbers = std::vector<uint64_t>;

TransitionChunk Chunk(uint64_t n, std::span<const uint8_t> payload = {}) {
  TransitionChunk chunk;
  chunk.first_sequence = n;
  chunk.payload = payload;
  return chunk;
}

WeightsPart Weights(uint32_t part, uint64_t update) {
  WeightsPart weights;
  weights.part = part;
  weights.version.update = update;
  return weights;
}

class LocalNetworkTest : public ::testing::Test {
 protected:
  std::unique_ptr<Reader<TransitionChunk>> ReadChunks(Hub& hub, Gate* gate) {
    return std::make_unique<Reader<TransitionChunk>>(
        hub, [gate](const TransitionChunk& chunk) { gate->Pass(chunk.first_sequence); });
  }

  LocalNetwork network_;
  const std::unique_ptr<Hub> replay_ = network_.Join(Role::kReplay);
  const std::unique_ptr<Hub> learner_ = network_.Join(Role::kLearner);
  const std::unique_ptr<Hub> actor_ = network_.Join(Role::kActor);
};

TEST_F(LocalNetworkTest, WritersAndReadersMatchWhenTheyAreMade) {
  Gate gate;
  Writer<TransitionChunk> writer(*actor_);
  EXPECT_EQ(writer.Matched(), 0);
  {
    const auto first = ReadChunks(*replay_, &gate), second = ReadChunks(*learner_, &gate);
    EXPECT_EQ(writer.Matched(), 2);
    EXPECT_EQ(first->Matched(), 1);
  }
  EXPECT_EQ(writer.Matched(), 0);
}

// 1 arrives before, 2 in between, 3 afterwards.
TEST_F(LocalNetworkTest, WhatIsWrittenToADisconnectedHubIsLostUntilItIsReconnected) {
  Gate gate;
  Writer<TransitionChunk> writer(*actor_);
  const auto reader = ReadChunks(*replay_, &gate);
  writer.Write(Chunk(1));
  gate.WaitForPassed(1);
  network_.Disconnect(*replay_);
  EXPECT_EQ(writer.Matched(), 0);
  EXPECT_EQ(reader->Matched(), 0);
  writer.Write(Chunk(2));
  network_.Reconnect(*replay_);
  EXPECT_EQ(writer.Matched(), 1);
  EXPECT_EQ(reader->Matched(), 1);
  writer.Write(Chunk(3));
  EXPECT_EQ(gate.WaitForPassed(2), (Numbers{1, 3}));
}

// The first chunk is in the callback, the second one in the queue.
TEST_F(LocalNetworkTest, ADisconnectedReaderHoldsNoWriterUp) {
  const std::vector<uint8_t> payload(UnreadBytesBound(Role::kActor) / 2);
  Gate gate;
  Writer<TransitionChunk> writer(*actor_);
  const auto reader = ReadChunks(*replay_, &gate);
  gate.Shut();
  writer.Write(Chunk(1));
  ASSERT_TRUE(gate.WaitForArrived(1));
  ASSERT_TRUE(writer.Write(Chunk(2, payload)));
  ASSERT_FALSE(writer.Write(Chunk(3, payload)));
  network_.Disconnect(*replay_);
  EXPECT_TRUE(writer.Write(Chunk(4, payload)));
  gate.Open();
  EXPECT_EQ(gate.WaitForPassed(1), (Numbers{1}));
}

// The reader takes the writer for a new one, as over a network.
TEST_F(LocalNetworkTest, HistoriesAreSentAgainInBothDirectionsAfterAReconnection) {
  Gate mine, others;
  Writer<WeightsPart> weights(*learner_);
  Writer<EvalMessage> evaluations(*actor_);
  const Reader<WeightsPart> on_actor(
      *actor_, [&](const WeightsPart& part) { mine.Pass(part.version.update); });
  const Reader<EvalMessage> on_learner(
      *learner_, [&](const EvalMessage& message) { others.Pass(message.env_steps); });
  weights.Write(Weights(1, 7));
  EvalMessage evaluation;
  evaluation.env_steps = 8;
  evaluations.Write(evaluation);
  mine.WaitForPassed(1);
  others.WaitForPassed(1);
  network_.Disconnect(*actor_);
  network_.Reconnect(*actor_);
  EXPECT_EQ(mine.WaitForPassed(2), (Numbers{7, 7}));
  EXPECT_EQ(others.WaitForPassed(2), (Numbers{8, 8}));
}

TEST_F(LocalNetworkTest, AnEndThatIsMadeWhileItsHubIsDisconnectedMatchesAfterwards) {
  Gate gate;
  Writer<WeightsPart> writer(*learner_);
  writer.Write(Weights(1, 7));
  network_.Disconnect(*actor_);
  const Reader<WeightsPart> reader(
      *actor_, [&](const WeightsPart& part) { gate.Pass(part.version.update); });
  EXPECT_EQ(reader.Matched(), 0);
  network_.Reconnect(*actor_);
  EXPECT_EQ(gate.WaitForPassed(1), (Numbers{7}));
}

TEST_F(LocalNetworkTest, AllReadersShareOneCopy) {
  const std::vector<uint8_t> payload(1000, 7);
  std::mutex mutex;
  std::set<const uint8_t*> places;
  const auto note = [&](const TransitionChunk& chunk) {
    const std::lock_guard lock(mutex);
    places.insert(chunk.payload.data());
  };
  Writer<TransitionChunk> writer(*actor_);
  const Reader<TransitionChunk> first(*replay_, note), second(*learner_, note);
  ASSERT_TRUE(writer.Write(Chunk(1, payload)));
  ASSERT_TRUE(writer.WaitForAcks(kDeadline));
  EXPECT_EQ(places.size(), 1u);
  EXPECT_FALSE(places.contains(payload.data()));
}

TEST_F(LocalNetworkTest, AReaderThatIsBehindGetsExactlyTheLastOfEachKey) {
  Gate gate;
  Writer<WeightsPart> writer(*learner_);
  const Reader<WeightsPart> reader(
      *actor_, [&](const WeightsPart& part) { gate.Pass(part.version.update); });
  gate.Shut();
  writer.Write(Weights(1, 1));
  ASSERT_TRUE(gate.WaitForArrived(1));  // the reader has it
  for (uint64_t n = 2; n <= 6; ++n) EXPECT_TRUE(writer.Write(Weights(1 + n % 2, n)));
  gate.Open();
  ASSERT_TRUE(writer.WaitForAcks(kDeadline)) << "an overwritten sample is not waited for";
  EXPECT_EQ(gate.WaitForPassed(3), (Numbers{1, 5, 6}));
}

TEST_F(LocalNetworkTest, CallbacksRunOnAThreadOfTheReadersHubOnePerPlane) {
  Gate replay_gate, other_gate, batch_gate;
  Writer<TransitionChunk> chunks(*replay_);  // of the same hub
  Writer<ControlMessage> control(*learner_);
  Writer<SampleRequest> requests(*learner_);
  const auto reader = ReadChunks(*replay_, &replay_gate);
  const Reader<ControlMessage> same_plane(*replay_,
                                          [&](const ControlMessage&) { other_gate.Pass(1); });
  const Reader<SampleRequest> other_plane(*replay_,
                                          [&](const SampleRequest&) { batch_gate.Pass(1); });
  for (uint64_t n = 1; n <= 20; ++n) chunks.Write(Chunk(n));
  control.Write({});
  requests.Write({});
  replay_gate.WaitForPassed(20);
  other_gate.WaitForPassed(1);
  batch_gate.WaitForPassed(1);
  ASSERT_EQ(replay_gate.threads().size(), 1u);
  EXPECT_FALSE(replay_gate.threads().contains(std::this_thread::get_id()));
  EXPECT_EQ(replay_gate.threads(), other_gate.threads());
  EXPECT_NE(replay_gate.threads(), batch_gate.threads());
}

// Ten chunks wait when the control message comes: it is second, not last.
TEST_F(LocalNetworkTest, TheReadersOfAPlaneTakeTurns) {
  Gate gate;
  Writer<TransitionChunk> chunks(*actor_);
  Writer<ControlMessage> control(*learner_);
  const auto reader = ReadChunks(*replay_, &gate);
  const Reader<ControlMessage> other(*replay_, [&](const ControlMessage&) { gate.Pass(100); });
  gate.Shut();
  for (uint64_t n = 1; n <= 10; ++n) chunks.Write(Chunk(n));
  ASSERT_TRUE(gate.WaitForArrived(1));
  control.Write({});
  gate.Open();
  EXPECT_EQ(gate.WaitForPassed(11), (Numbers{1, 100, 2, 3, 4, 5, 6, 7, 8, 9, 10}));
}

TEST_F(LocalNetworkTest, AWriterMayHaveTheUnreadBytesOfItsRole) {
  const std::vector<uint8_t> payload(UnreadBytesBound(Role::kActor) / 4 - sizeof(TransitionChunk));
  Gate gate;
  Writer<TransitionChunk> writer(*actor_);
  const auto reader = ReadChunks(*replay_, &gate);
  gate.Shut();
  for (uint64_t n = 1; n <= 4; ++n) EXPECT_TRUE(writer.Write(Chunk(n, payload)));
  EXPECT_FALSE(writer.Write(Chunk(5))) << "not a byte more";
  gate.Open();
  EXPECT_TRUE(writer.Write(Chunk(5)));
  EXPECT_EQ(gate.WaitForPassed(5), (Numbers{1, 2, 3, 4, 5}));
}

TEST_F(LocalNetworkTest, ASampleIsUnreadUntilTheSlowestReadersCallbackHasReturned) {
  Gate fast, slow;
  Writer<TransitionChunk> writer(*actor_);
  const auto first = ReadChunks(*replay_, &fast), second = ReadChunks(*learner_, &slow);
  slow.Shut();
  writer.Write(Chunk(1));
  ASSERT_TRUE(slow.WaitForArrived(1));
  fast.WaitForPassed(1);
  EXPECT_FALSE(writer.WaitForAcks(std::chrono::milliseconds(0)));
  EXPECT_FALSE(writer.WaitForAcks(std::chrono::milliseconds(50)));
  slow.Open();
  EXPECT_TRUE(writer.WaitForAcks(kDeadline));
}

TEST_F(LocalNetworkTest, AReadersEndReleasesWhatItHasNotRead) {
  const std::vector<uint8_t> payload(UnreadBytesBound(Role::kActor));
  Gate gate;
  Writer<TransitionChunk> writer(*actor_);
  auto reader = ReadChunks(*replay_, &gate);
  gate.Shut();
  ASSERT_TRUE(writer.Write(Chunk(1)));
  ASSERT_TRUE(gate.WaitForArrived(1));
  ASSERT_TRUE(writer.Write(Chunk(2)));
  EXPECT_FALSE(writer.Write(Chunk(3, payload)));
  gate.Open();
  reader.reset();
  EXPECT_TRUE(writer.WaitForAcks(std::chrono::milliseconds(0)));
  EXPECT_TRUE(writer.Write(Chunk(3, payload)));
}

TEST_F(LocalNetworkTest, WhatAWriterWroteBeforeItsEndArrives) {
  Gate gate;
  std::optional<Writer<TransitionChunk>> writer(*actor_);
  const auto reader = ReadChunks(*replay_, &gate);
  gate.Shut();
  for (uint64_t n = 1; n <= 5; ++n) writer->Write(Chunk(n));
  writer.reset();
  EXPECT_EQ(reader->Matched(), 0);
  gate.Open();
  EXPECT_EQ(gate.WaitForPassed(5), (Numbers{1, 2, 3, 4, 5}));
}

TEST_F(LocalNetworkTest, AnEndedWriterHasNoHistory) {
  Gate gate;
  { Writer<WeightsPart>(*learner_).Write(Weights(1, 1)); }
  Writer<WeightsPart> writer(*learner_);
  writer.Write(Weights(1, 2));
  const Reader<WeightsPart> reader(
      *actor_, [&](const WeightsPart& part) { gate.Pass(part.version.update); });
  EXPECT_TRUE(writer.WaitForAcks(kDeadline));
  EXPECT_EQ(gate.WaitForPassed(1), Numbers{2});
}

TEST_F(LocalNetworkTest, NetworksDoNotMix) {
  LocalNetwork other;
  const std::unique_ptr<Hub> stranger = other.Join(Role::kActor);
  const Writer<TransitionChunk> writer(*stranger);
  Gate gate;
  const auto reader = ReadChunks(*replay_, &gate);
  EXPECT_EQ(writer.Matched(), 0);
  EXPECT_EQ(reader->Matched(), 0);
}

TEST(LocalNetworkDeathTest, AHubMustNotOutliveItsNetwork) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        auto network = std::make_unique<LocalNetwork>();
        const std::unique_ptr<Hub> hub = network->Join(Role::kActor);
        network.reset();
      },
      "1 hubs outlive their network");
}

TEST(LocalNetworkDeathTest, AWriterMustNotOutliveItsHub) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        LocalNetwork network;
        std::unique_ptr<Hub> hub = network.Join(Role::kActor);
        const Writer<TransitionChunk> writer(*hub);
        hub.reset();
      },
      "hub of role actor: 1 writers and readers are left");
}

TEST(LocalNetworkDeathTest, ARoleUsesItsPlanesOnly) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  LocalNetwork network;
  const std::unique_ptr<Hub> actor = network.Join(Role::kActor);
  EXPECT_DEATH(Reader<BatchPart>(*actor, [](const BatchPart&) {}),
               "topic batch_part_v2: role actor is not in its plane");
  EXPECT_DEATH(Writer<BatchPart>{*actor}, "topic batch_part_v2: role actor is not in its plane");
}

TEST(LocalNetworkDeathTest, ACallbackMakesNoReader) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        LocalNetwork network;
        const std::unique_ptr<Hub> replay = network.Join(Role::kReplay);
        Writer<TransitionChunk> writer(*replay);
        const Reader<TransitionChunk> reader(*replay, [&](const TransitionChunk&) {
          const Writer<CreditsMessage> credits(*replay);
        });
        writer.Write(Chunk(1));
        writer.WaitForAcks(kDeadline);
      },
      "topic credits: a callback must not make or destroy writers and readers");
}

}  // namespace
}  // namespace shoal::link

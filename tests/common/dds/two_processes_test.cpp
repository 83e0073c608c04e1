// SPDX-License-Identifier: Apache-2.0
// Messages between two processes through sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "common/dds/bus.h"
#include "tests/common/dds/exchange.h"
#include "tests/common/dds/peer_process.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"

namespace shoal::dds {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class TwoProcessesTest : public ::testing::Test {
 protected:
  PeerProcess coordinator_;
  const ClusterAddress address_ = coordinator_.address();
};

TEST_F(TwoProcessesTest, MessagesBetweenActorAndReplayArriveAsSent) {
  PeerProcess replay("replay", address_), actor("actor", address_);
  ExpectSame<TransitionChunk>(actor, replay, "TransitionChunk");
  ExpectSame<CreditsMessage>(replay, actor, "CreditsMessage");
}

TEST_F(TwoProcessesTest, MessagesBetweenLearnerAndReplayArriveAsSent) {
  PeerProcess learner("learner", address_), replay("replay", address_);
  ExpectSame<SampleRequest>(learner, replay, "SampleRequest");
  ExpectSame<BatchSlot>(replay, learner, "BatchSlot");
  ExpectSame<BatchPart>(replay, learner, "BatchPart");
}

TEST_F(TwoProcessesTest, MessagesFromLearnerToActorArriveAsSent) {
  PeerProcess learner("learner", address_), actor("actor", address_), eval("eval", address_);
  ExpectSame<WeightsPart>(learner, actor, "WeightsPart");
  ExpectSame<EvalWeightsPart>(learner, eval, "EvalWeightsPart");
}

TEST_F(TwoProcessesTest, MessagesBetweenOthersAndCoordinatorArriveAsSent) {
  PeerProcess actor("actor", address_), eval("eval", address_), learner("learner", address_),
      replay("replay", address_);
  ExpectSame<ActorMetrics>(actor, coordinator_, "ActorMetrics");
  ExpectSame<EvalMetrics>(eval, coordinator_, "EvalMetrics");
  ExpectSame<LearnerMetrics>(learner, coordinator_, "LearnerMetrics");
  ExpectSame<ReplayMetrics>(replay, coordinator_, "ReplayMetrics");
  ExpectSame<LearnerProgress>(learner, coordinator_, "LearnerProgress");
  ExpectSame<ReplayProgress>(replay, coordinator_, "ReplayProgress");
  ExpectSame<EvalMessage>(eval, coordinator_, "EvalMessage");
  ExpectSame<ControlMessage>(coordinator_, actor, "ControlMessage");
}

TEST_F(TwoProcessesTest, MessagesBetweenCoordinatorAndClientArriveAsSent) {
  ClusterAddress without_tag = address_;
  without_tag.tag = "-";  // a client knows host and port only
  PeerProcess client("client", without_tag);
  ExpectSame<RunViewMessage>(coordinator_, client, "RunViewMessage");
  ExpectSame<CommandMessage>(client, coordinator_, "CommandMessage");
  ExpectSame<ReplyMessage>(coordinator_, client, "ReplyMessage");
}

TEST_F(TwoProcessesTest, ALateActorGetsTheNewestWeightsCreditAndControl) {
  PeerProcess learner("learner", address_), replay("replay", address_);
  learner.Ask("publish WeightsPart");
  learner.Ask("write WeightsPart 1 3 3000000");
  replay.Ask("publish CreditsMessage");
  replay.Ask("write CreditsMessage 3 1 0");
  coordinator_.Ask("publish ControlMessage");
  coordinator_.Ask("write ControlMessage 1 3 0");
  PeerProcess actor("actor", address_);
  const auto newest = [&](const std::string& name) {
    EXPECT_EQ(actor.Ask("show " + name), "ok");
    std::string got = actor.NextGot();
    EXPECT_THAT(actor.Ask("received " + name + " 1 5000"), StartsWith("received 1 "));
    return got;
  };
  // The payload is that of the first message of the write.
  const std::vector<uint8_t> payload = ExamplePayload(1, 3'000'000);
  WithExample<WeightsPart>(3, payload, [&](const WeightsPart& message) {
    EXPECT_EQ(newest("WeightsPart"), "got WeightsPart " + Describe(message));
  });
  EXPECT_EQ(newest("CreditsMessage"), Expected<CreditsMessage>("CreditsMessage", 3, 0));
  EXPECT_EQ(newest("ControlMessage"), Expected<ControlMessage>("ControlMessage", 3, 0));
}

TEST_F(TwoProcessesTest, ProcessesOfAnotherTagAreNotSeen) {
  PeerProcess replay("replay", address_);
  ClusterAddress other = address_;
  other.tag += "-other";
  PeerProcess stranger("actor", other), actor("actor", address_);
  replay.Ask("subscribe TransitionChunk");
  stranger.Ask("publish TransitionChunk");
  actor.Ask("publish TransitionChunk");
  EXPECT_EQ(actor.Ask("match TransitionChunk 1 10000"), "matched 1");
  EXPECT_EQ(replay.Ask("match TransitionChunk 1 10000"), "matched 1");
  EXPECT_EQ(stranger.Ask("match TransitionChunk 1 1500"), "matched 0");
}

// Speed is recorded, not judged: the machine is shared.
TEST_F(TwoProcessesTest, MegabytePartsAtFullSpeedLoseNothing) {
  constexpr uint64_t kParts = 500;
  constexpr uint64_t kBytes = 1'000'000;
  PeerProcess learner("learner", address_), replay("replay", address_);
  learner.Ask("subscribe BatchPart");
  replay.Ask("publish BatchPart");
  ASSERT_EQ(replay.Ask("match BatchPart 1 10000"), "matched 1");
  const std::string wrote = replay.Ask(fmt::format("write BatchPart 1 {} {}", kParts, kBytes));
  EXPECT_THAT(wrote, HasSubstr(fmt::format("wrote {} ", kParts)));
  EXPECT_EQ(learner.Ask(fmt::format("received BatchPart {} 20000", kParts)),
            fmt::format("received {} gaps 0 bytes {} malformed 0", kParts, kParts * kBytes));
  RecordProperty("parts_1MB", wrote);
}

TEST_F(TwoProcessesTest, ChunksFromFourActorsAtOnceLoseNothing) {
  constexpr uint64_t kChunks = 200;
  PeerProcess replay("replay", address_);
  replay.Ask("subscribe TransitionChunk");
  std::vector<std::unique_ptr<PeerProcess>> actors;
  for (int i = 0; i < 4; ++i) {
    actors.push_back(std::make_unique<PeerProcess>("actor", address_));
    actors.back()->Ask("publish TransitionChunk");
    ASSERT_EQ(actors.back()->Ask("match TransitionChunk 1 10000"), "matched 1");
  }
  for (auto& actor : actors) {
    actor->Send(fmt::format("write TransitionChunk 1 {} 1000000", kChunks));
  }
  for (auto& actor : actors) {
    EXPECT_THAT(actor->Answer(), StartsWith(fmt::format("wrote {} ", kChunks)));
  }
  EXPECT_THAT(replay.Ask(fmt::format("received TransitionChunk {} 20000", 4 * kChunks)),
              StartsWith(fmt::format("received {} ", 4 * kChunks)));
}

TEST_F(TwoProcessesTest, AChunkIsAnsweredByItsCredit) {
  PeerProcess replay("replay", address_), actor("actor", address_);
  replay.Ask("answer");
  const std::string small = actor.Ask("roundtrip 300 200000");
  EXPECT_THAT(small, StartsWith("microseconds "));
  const std::string large = actor.Ask("roundtrip 300 1000000");
  EXPECT_THAT(large, StartsWith("microseconds "));
  RecordProperty("round_trip_200kB", small);
  RecordProperty("round_trip_1MB", large);
}

}  // namespace
}  // namespace shoal::dds

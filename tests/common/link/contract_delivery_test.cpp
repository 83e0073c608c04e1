// SPDX-License-Identifier: Apache-2.0
// The contract of hub.h: which samples arrive, in which order, and when a write waits.
#include <algorithm>

#include "tests/common/link/contract_fixture.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"

namespace shoal::link {
namespace {

using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::StartsWith;

class ContractDeliveryTest : public ContractTest {};

// ---- Reliable

TEST_P(ContractDeliveryTest, MessagesArriveAsTheyWereWritten) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  const auto expect_same = [&]<class M>(ContractPeer& from, ContractPeer& to, const char* type,
                                        const M&) {
    constexpr uint64_t kNumber = 41;
    constexpr size_t kBytes = 100'000;
    EXPECT_EQ(to.Ask(fmt::format("show {}", type)), "ok");
    EXPECT_EQ(from.Ask(fmt::format("publish {}", type)), "ok");
    ExpectMatched(from, type, 1);
    Write(from, type, kNumber, kNumber, kBytes);
    WithExample<M>(kNumber, ExamplePayload(kNumber, kBytes), [&](const M& message) {
      EXPECT_EQ(to.NextGot(), fmt::format("got {} {}", type, Describe(message)));
    });
  };
  expect_same(*actor, *replay, "TransitionChunk", TransitionChunk());
  expect_same(*replay, *actor, "CreditsMessage", CreditsMessage());
}

TEST_P(ContractDeliveryTest, EverySampleArrivesOnceInTheOrderOfItsWriter) {
  const Peer replay = Join(Role::kReplay), first = Join(Role::kActor), second = Join(Role::kActor);
  Connect(*first, *replay, "TransitionChunk");
  EXPECT_EQ(second->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*second, "TransitionChunk", 1);
  ExpectMatched(*replay, "TransitionChunk", 2);
  first->Send("write TransitionChunk 1 200 20000");
  second->Send("write TransitionChunk 1001 200 20000");
  EXPECT_THAT(first->Answer(), StartsWith("wrote 200 "));
  EXPECT_THAT(second->Answer(), StartsWith("wrote 200 "));
  ExpectReceived(*replay, "TransitionChunk", 400);
  Numbers of_first, of_second;
  for (const uint64_t n : Seen(*replay, "TransitionChunk")) {
    (n <= 1000 ? of_first : of_second).push_back(n);
  }
  EXPECT_EQ(of_first, Range(1, 200));
  EXPECT_EQ(of_second, Range(1001, 1200));
}

TEST_P(ContractDeliveryTest, AWriterAndAReaderOfOneHubMatchToo) {
  const Peer replay = Join(Role::kReplay);
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*replay, "TransitionChunk", 2);
  Write(*replay, "TransitionChunk", 1, 20);
  ExpectReceived(*replay, "TransitionChunk", 20);
}

// ---- History

TEST_P(ContractDeliveryTest, AReaderThatIsBehindGetsTheNewestSampleOfEachKey) {
  const Peer learner = Join(Role::kLearner), actor = Join(Role::kActor);
  Connect(*learner, *actor, "WeightsPart");
  HoldWith(*actor, *learner, "WeightsPart", 1);
  for (uint64_t n = 2; n <= 40; ++n) {
    Write(*learner, "WeightsPart", n, n, 1000, "10");
    Write(*learner, "WeightsPart", 100 + n, 100 + n, 1000, "11");
  }
  EXPECT_EQ(actor->Ask("release WeightsPart"), "ok");
  EXPECT_TRUE(WaitFor(*actor, "WeightsPart", 10, 40));
  EXPECT_TRUE(WaitFor(*actor, "WeightsPart", 11, 140));
  for (const auto& [key, numbers] : SeenByKey(*actor, "WeightsPart")) {
    EXPECT_TRUE(std::ranges::is_sorted(numbers, std::less_equal())) << "order and no duplicate";
  }
}

TEST_P(ContractDeliveryTest, TheLastNOfEachKeyAreKept) {
  const Peer coordinator = Join(Role::kCoordinator), actor = Join(Role::kActor);
  Connect(*actor, *coordinator, "ActorMetrics");
  HoldWith(*coordinator, *actor, "ActorMetrics", 1);
  Write(*actor, "ActorMetrics", 11, 60, 0, "1");
  Write(*actor, "ActorMetrics", 111, 160, 0, "2");
  EXPECT_EQ(coordinator->Ask("release ActorMetrics"), "ok");
  ASSERT_TRUE(WaitFor(*coordinator, "ActorMetrics", 1, 60));
  ASSERT_TRUE(WaitFor(*coordinator, "ActorMetrics", 2, 160));
  const std::map<uint64_t, Numbers> seen = SeenByKey(*coordinator, "ActorMetrics");
  EXPECT_THAT(seen.at(1), IsSupersetOf(Range(53, 60)));
  EXPECT_THAT(seen.at(2), IsSupersetOf(Range(153, 160)));
}

TEST_P(ContractDeliveryTest, AWriterThatKeepsTheLastIsNeverRefused) {
  const Peer learner = Join(Role::kLearner), actor = Join(Role::kActor);
  Connect(*learner, *actor, "WeightsPart");
  HoldWith(*actor, *learner, "WeightsPart", 1);
  for (uint64_t key = 0; key < 40; ++key) {
    EXPECT_THAT(learner->Ask(fmt::format("write WeightsPart {} 1 1000000 {}", key + 2, key)),
                StartsWith("wrote 1 refused 0 "));
  }
}

TEST_P(ContractDeliveryTest, ARefusedSampleReachesNobodyAndIsWrittenAgain) {
  constexpr size_t kBytes = 500'000;
  const Peer replay = Join(Role::kReplay), learner = Join(Role::kLearner),
             actor = Join(Role::kActor);
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(learner->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(actor->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 2);
  ExpectMatched(*replay, "TransitionChunk", 1);
  ExpectMatched(*learner, "TransitionChunk", 1);
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  const uint64_t refused = WriteUntilRefused(*actor, "TransitionChunk", 2, kBytes);
  // The caller goes on with another number, so that a refused sample that was sent would be seen.
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  Write(*actor, "TransitionChunk", refused + 1000, refused + 1000, kBytes);
  Write(*actor, "TransitionChunk", refused, refused + 3, kBytes);
  Numbers expected = Range(1, refused - 1);
  expected.push_back(refused + 1000);
  for (const uint64_t n : Range(refused, refused + 3)) expected.push_back(n);
  for (ContractPeer* reader : {replay.get(), learner.get()}) {
    ExpectReceived(*reader, "TransitionChunk", expected.size());
    EXPECT_EQ(Seen(*reader, "TransitionChunk"), expected);
  }
}

TEST_P(ContractDeliveryTest, AWriteWaitsForRoomAndIsRefusedAfterMaxBlocking) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  const uint64_t next = WriteUntilRefused(*actor, "TransitionChunk", 2, 500'000);
  const std::string answer = actor->Ask(fmt::format("try TransitionChunk {} 500000", next));
  ASSERT_THAT(answer, StartsWith("refused "));
  const int waited_ms = std::stoi(answer.substr(answer.find(' ')));
  EXPECT_GE(waited_ms, 190) << "it waits";
  EXPECT_LT(waited_ms, 10'000) << "but not for ever: 200 ms";
}

TEST_P(ContractDeliveryTest, AWaitingWriteGoesOnWhenTheReaderHasTakenSomething) {
  const Peer replay = Join(Role::kReplay), learner = Join(Role::kLearner);
  Connect(*replay, *learner, "BatchPart");
  HoldWith(*learner, *replay, "BatchPart", 1);
  const uint64_t next = WriteUntilRefused(*replay, "BatchPart", 2, 1'000'000);
  replay->Send(fmt::format("announce BatchPart {} 1000000", next));
  EXPECT_EQ(replay->NextGot(), "got trying BatchPart");
  EXPECT_EQ(learner->Ask("waiting BatchPart 20000"), "yes") << "time for the write to begin";
  EXPECT_EQ(learner->Ask("release BatchPart"), "ok");
  const std::string answer = replay->Answer();
  ASSERT_THAT(answer, StartsWith("sent "));
  EXPECT_LT(std::stoi(answer.substr(answer.find(' '))), 1900) << "not at the end of its 2 s";
  ExpectReceived(*learner, "BatchPart", next);
}

TEST_P(ContractDeliveryTest, AWaitingWriteGoesOnWhenTheReaderEnds) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  const uint64_t next = WriteUntilRefused(*actor, "TransitionChunk", 2, 500'000);
  EXPECT_EQ(replay->Ask("unsubscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  Write(*actor, "TransitionChunk", next, next + 20, 500'000);
}

TEST_P(ContractDeliveryTest, TheBoundIsThatOfOneWriter) {
  const Peer replay = Join(Role::kReplay), first = Join(Role::kActor), second = Join(Role::kActor);
  Connect(*first, *replay, "TransitionChunk");
  EXPECT_EQ(second->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*second, "TransitionChunk", 1);
  HoldWith(*replay, *first, "TransitionChunk", 1);
  WriteUntilRefused(*first, "TransitionChunk", 2, 500'000);
  EXPECT_THAT(second->Ask("try TransitionChunk 1 500000"), StartsWith("sent "));
}

TEST_P(ContractDeliveryTest, ASampleAboveTheBoundIsSentWhenNothingIsUnread) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  EXPECT_THAT(actor->Ask("try TransitionChunk 1 5000000"), StartsWith("sent "));
  ExpectReceived(*replay, "TransitionChunk", 1);
}

// ---- Late joiners

TEST_P(ContractDeliveryTest, ALateReaderGetsTheLastNSamplesOfEachKey) {
  const Peer coordinator = Join(Role::kCoordinator), learner = Join(Role::kLearner),
             replay = Join(Role::kReplay), eval = Join(Role::kEval);
  EXPECT_EQ(learner->Ask("publish WeightsPart"), "ok");
  Write(*learner, "WeightsPart", 1, 5, 1000, "1");
  Write(*learner, "WeightsPart", 11, 15, 1000, "2");
  EXPECT_EQ(replay->Ask("publish CreditsMessage"), "ok");
  Write(*replay, "CreditsMessage", 1, 20);
  EXPECT_EQ(eval->Ask("publish EvalMessage"), "ok");
  Write(*eval, "EvalMessage", 1, 40);
  const Peer actor = Join(Role::kActor);
  EXPECT_EQ(actor->Ask("subscribe WeightsPart"), "ok");
  EXPECT_EQ(actor->Ask("subscribe CreditsMessage"), "ok");
  EXPECT_EQ(coordinator->Ask("subscribe EvalMessage"), "ok");
  ExpectReceived(*actor, "WeightsPart", 2);
  ExpectReceived(*actor, "CreditsMessage", 16);
  ExpectReceived(*coordinator, "EvalMessage", 32);
  // The next sample arrives after the old ones.
  Write(*learner, "WeightsPart", 6, 6, 1000, "1");
  Write(*replay, "CreditsMessage", 21, 21);
  Write(*eval, "EvalMessage", 41, 41);
  ExpectReceived(*actor, "WeightsPart", 3);
  ExpectReceived(*actor, "CreditsMessage", 17);
  ExpectReceived(*coordinator, "EvalMessage", 33);
  EXPECT_THAT(SeenByKey(*actor, "WeightsPart"),
              ElementsAre(std::pair(1, Numbers{5, 6}), std::pair(2, Numbers{15})));
  EXPECT_EQ(Seen(*actor, "CreditsMessage"), Range(5, 21));
  EXPECT_EQ(Seen(*coordinator, "EvalMessage"), Range(9, 41));
}

TEST_P(ContractDeliveryTest, ATopicWithoutLateJoinersGivesNothingOld) {
  const Peer coordinator = Join(Role::kCoordinator), actor = Join(Role::kActor),
             replay = Join(Role::kReplay);
  EXPECT_EQ(actor->Ask("publish ActorMetrics"), "ok");
  EXPECT_EQ(actor->Ask("publish TransitionChunk"), "ok");
  Write(*actor, "ActorMetrics", 1, 3);
  Write(*actor, "TransitionChunk", 1, 3);
  EXPECT_EQ(coordinator->Ask("subscribe ActorMetrics"), "ok");
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  ExpectMatched(*actor, "ActorMetrics", 1);
  ExpectMatched(*actor, "TransitionChunk", 1);
  Write(*actor, "ActorMetrics", 4, 4);
  Write(*actor, "TransitionChunk", 4, 4);
  ExpectReceived(*coordinator, "ActorMetrics", 1);
  ExpectReceived(*replay, "TransitionChunk", 1);
  EXPECT_EQ(Seen(*coordinator, "ActorMetrics"), Numbers{4});
  EXPECT_EQ(Seen(*replay, "TransitionChunk"), Numbers{4});
}

SHOAL_INSTANTIATE_CONTRACT(ContractDeliveryTest);

}  // namespace
}  // namespace shoal::link

// SPDX-License-Identifier: Apache-2.0
// The contract of hub.h: matches, deaths, restarts, threads, memory and acknowledgements.
#include "tests/common/link/contract_fixture.h"
#include "tests/common/link/example_messages.h"
#include "tests/common/link/message_text.h"

namespace shoal::link {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

class ContractLifeTest : public ContractTest {};

// ---- Matching, liveness, restart

TEST_P(ContractLifeTest, BothSidesCountTheirMatchesAlsoAfterAnEnd) {
  const Peer replay = Join(Role::kReplay);
  Peer actor = Join(Role::kActor);
  EXPECT_EQ(actor->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 0);
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 1);
  ExpectMatched(*replay, "TransitionChunk", 1);
  EXPECT_EQ(replay->Ask("unsubscribe TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 0);
  EXPECT_EQ(replay->Ask("unsubscribed TransitionChunk 20000"), "yes");
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  ExpectMatched(*replay, "TransitionChunk", 1);
  EXPECT_EQ(actor->Ask("unpublish TransitionChunk"), "ok");
  ExpectMatched(*replay, "TransitionChunk", 0);
  EXPECT_EQ(actor->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*replay, "TransitionChunk", 1);
  actor->Quit();
  ExpectMatched(*replay, "TransitionChunk", 0);
}

TEST_P(ContractLifeTest, APeerThatDiesWithoutAWordIsForgottenAndHoldsUpNobody) {
  const Peer replay = Join(Role::kReplay), learner = Join(Role::kLearner),
             actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  Connect(*replay, *actor, "CreditsMessage");
  EXPECT_EQ(learner->Ask("subscribe TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 2);
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  const uint64_t next = WriteUntilRefused(*actor, "TransitionChunk", 2, 500'000);
  replay->Kill();
  const SteadyTime killed = Now();
  Write(*actor, "TransitionChunk", next, next + 20, 500'000);
  ExpectMatched(*actor, "TransitionChunk", 1);
  ExpectMatched(*actor, "CreditsMessage", 0);
  EXPECT_LT(Now() - killed, 3 * kLivenessLimit) << "three times, as the machine may be busy";
  ExpectReceived(*learner, "TransitionChunk", next + 20);
}

TEST_P(ContractLifeTest, ARestartedWriterHasNoHistoryButItsOwn) {
  Peer learner = Join(Role::kLearner);
  EXPECT_EQ(learner->Ask("publish WeightsPart"), "ok");
  Write(*learner, "WeightsPart", 1, 1, 1000, "1");
  Write(*learner, "WeightsPart", 2, 2, 1000, "2");
  learner->Quit();
  learner = Join(Role::kLearner);
  EXPECT_EQ(learner->Ask("publish WeightsPart"), "ok");
  Write(*learner, "WeightsPart", 10, 10, 1000, "1");
  const Peer actor = Join(Role::kActor);
  EXPECT_EQ(actor->Ask("subscribe WeightsPart"), "ok");
  ExpectReceived(*actor, "WeightsPart", 1);
  // The next sample would arrive after any old one.
  ExpectMatched(*learner, "WeightsPart", 1);
  Write(*learner, "WeightsPart", 11, 11, 1000, "1");
  ExpectReceived(*actor, "WeightsPart", 2);
  EXPECT_THAT(SeenByKey(*actor, "WeightsPart"), ElementsAre(std::pair(1, Numbers{10, 11})));
}

// ---- Threads

TEST_P(ContractLifeTest, ASlowCallbackDelaysItsPlaneOnly) {
  const Peer replay = Join(Role::kReplay), learner = Join(Role::kLearner),
             coordinator = Join(Role::kCoordinator), client = Join(Role::kClient);
  Connect(*learner, *replay, "SampleRequest");
  Connect(*coordinator, *replay, "ControlMessage");
  Connect(*replay, *coordinator, "ReplayMetrics");
  Connect(*client, *coordinator, "CommandMessage");
  HoldWith(*replay, *coordinator, "ControlMessage", 1);  // main
  Write(*learner, "SampleRequest", 1, 1);                // batch
  ExpectReceived(*replay, "SampleRequest", 1);
  EXPECT_EQ(replay->Ask("release ControlMessage"), "ok");
  HoldWith(*replay, *learner, "SampleRequest", 2);  // batch
  Write(*coordinator, "ControlMessage", 2, 2);      // main
  ExpectReceived(*replay, "ControlMessage", 2);
  HoldWith(*coordinator, *replay, "ReplayMetrics", 1);  // main
  Write(*client, "CommandMessage", 1, 1);               // operate
  ExpectReceived(*coordinator, "CommandMessage", 1);
}

TEST_P(ContractLifeTest, CallbacksOfAReaderRunOneAtATime) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  // While a callback runs for long.
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  Write(*actor, "TransitionChunk", 2, 20);
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  ExpectReceived(*replay, "TransitionChunk", 20);
  // While many arrive. A writer of the reader's own hub may call back on the writing thread.
  EXPECT_EQ(replay->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*replay, "TransitionChunk", 3);
  ExpectMatched(*actor, "TransitionChunk", 1);
  actor->Send("write TransitionChunk 21 1000 100");
  replay->Send("write TransitionChunk 10001 1000 100");
  EXPECT_THAT(actor->Answer(), StartsWith("wrote 1000 "));
  EXPECT_THAT(replay->Answer(), StartsWith("wrote 1000 "));
  ExpectReceived(*replay, "TransitionChunk", 2020);
  EXPECT_EQ(replay->Ask("overlaps TransitionChunk"), "overlaps 0");
}

TEST_P(ContractLifeTest, ADestructorOfAReaderWaitsForItsCallback) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  Write(*actor, "TransitionChunk", 2, 3);
  EXPECT_EQ(replay->Ask("unsubscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("unsubscribed TransitionChunk 300"), "no");
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("unsubscribed TransitionChunk 20000"), "yes");
}

// ---- Memory

// On a thread for each write, as a writer may be used by any.
TEST_P(ContractLifeTest, AWriterCopiesThePayloadBeforeItReturns) {
  constexpr uint64_t kCount = 6;
  constexpr size_t kBytes = 100'000;
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  EXPECT_EQ(replay->Ask("hold TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("show TransitionChunk"), "ok");
  EXPECT_EQ(actor->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 1);
  ExpectMatched(*replay, "TransitionChunk", 1);
  EXPECT_THAT(actor->Ask(fmt::format("scribble TransitionChunk 1 {} {}", kCount, kBytes)),
              StartsWith(fmt::format("wrote {} ", kCount)));
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  for (uint64_t n = 1; n <= kCount; ++n) {
    WithExample<TransitionChunk>(n, ExamplePayload(n, kBytes), [&](const TransitionChunk& chunk) {
      EXPECT_EQ(replay->NextGot(), "got TransitionChunk " + Describe(chunk));
    });
  }
}

// ---- Acknowledgements and damage

TEST_P(ContractLifeTest, AcknowledgementsWaitForEveryReader) {
  const Peer replay = Join(Role::kReplay), learner = Join(Role::kLearner),
             actor = Join(Role::kActor);
  EXPECT_EQ(actor->Ask("publish TransitionChunk"), "ok");
  EXPECT_EQ(actor->Ask("acknowledged TransitionChunk 0"), "yes") << "without a reader";
  EXPECT_EQ(learner->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  ExpectMatched(*actor, "TransitionChunk", 2);
  ExpectMatched(*replay, "TransitionChunk", 1);
  ExpectMatched(*learner, "TransitionChunk", 1);
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  Write(*actor, "TransitionChunk", 2, 3);
  ExpectReceived(*learner, "TransitionChunk", 3);
  EXPECT_EQ(actor->Ask("acknowledged TransitionChunk 100"), "no");
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  EXPECT_EQ(actor->Ask("acknowledged TransitionChunk 20000"), "yes");
  ExpectReceived(*replay, "TransitionChunk", 3);
}

TEST_P(ContractLifeTest, MalformedListsEveryTopicThatWasRead) {
  const Peer replay = Join(Role::kReplay);
  EXPECT_EQ(replay->Ask("malformed"), "malformed");
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("subscribe SampleRequest"), "ok");
  EXPECT_EQ(replay->Ask("publish BatchPart"), "ok");
  EXPECT_EQ(replay->Ask("unsubscribe SampleRequest"), "ok");
  EXPECT_EQ(replay->Ask("unsubscribed SampleRequest 20000"), "yes");
  EXPECT_EQ(replay->Ask("malformed"), "malformed sample_request:0 transitions_v1:0");
}

SHOAL_INSTANTIATE_CONTRACT(ContractLifeTest);

}  // namespace
}  // namespace shoal::link

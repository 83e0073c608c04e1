// SPDX-License-Identifier: Apache-2.0
// The contract of hub.h, sentence by sentence, for each implementation of the link. Members of a
// run are driven by commands (peer_commands.h): processes for DDS, threads for the local link.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/link/hub.h"
#include "tests/common/link/contract_network.h"
#include "tests/common/link/example_messages.h"

namespace shoal::link {
namespace {

using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::StartsWith;

struct Implementation {
  const char* name;
  std::unique_ptr<ContractNetwork> (*make)();
};

constexpr std::chrono::seconds kDeadline{20};

using Numbers = std::vector<uint64_t>;

// FIRST, FIRST + 1, ... LAST.
Numbers Range(uint64_t first, uint64_t last) {
  Numbers numbers;
  for (uint64_t n = first; n <= last; ++n) numbers.push_back(n);
  return numbers;
}

class ContractTest : public ::testing::TestWithParam<Implementation> {
 protected:
  using Peer = std::unique_ptr<ContractPeer>;

  Peer Join(Role role) { return network_->Join(role); }

  // A writer and a reader of `type`, which both sides count as matched.
  static void Connect(ContractPeer& writer, ContractPeer& reader, const std::string& type) {
    ASSERT_EQ(reader.Ask("subscribe " + type), "ok");
    ASSERT_EQ(writer.Ask("publish " + type), "ok");
    ExpectMatched(writer, type, 1);
    ExpectMatched(reader, type, 1);
  }

  static void ExpectMatched(ContractPeer& peer, const std::string& type, int count) {
    EXPECT_EQ(peer.Ask(fmt::format("match {} {} 20000", type, count)),
              fmt::format("matched {}", count))
        << type;
  }

  // Writes numbers FIRST to LAST; each is accepted in the end.
  static void Write(ContractPeer& peer, const std::string& type, uint64_t first, uint64_t last,
                    size_t bytes = 1000, const std::string& key = "") {
    const uint64_t count = last - first + 1;
    EXPECT_THAT(peer.Ask(fmt::format("write {} {} {} {} {}", type, first, count, bytes, key)),
                StartsWith(fmt::format("wrote {} ", count)));
  }

  static void ExpectReceived(ContractPeer& peer, const std::string& type, uint64_t count) {
    EXPECT_THAT(peer.Ask(fmt::format("received {} {} 20000", type, count)),
                StartsWith(fmt::format("received {} ", count)));
  }

  // The numbers that were delivered, by key, in the order of the callbacks.
  static std::map<uint64_t, Numbers> SeenByKey(ContractPeer& peer, const std::string& type) {
    std::istringstream words(peer.Ask("seen " + type));
    std::string word;
    words >> word;
    EXPECT_EQ(word, "seen");
    std::map<uint64_t, Numbers> seen;
    uint64_t key = 0, number = 0;
    for (char colon = 0; words >> key >> colon >> number;) seen[key].push_back(number);
    return seen;
  }

  // Waits until the message of that key was delivered.
  static bool WaitFor(ContractPeer& peer, const std::string& type, uint64_t key, uint64_t number) {
    const SteadyTime start = Now();
    for (;;) {
      const std::map<uint64_t, Numbers> seen = SeenByKey(peer, type);
      const auto of_key = seen.find(key);
      if (of_key != seen.end() && of_key->second.back() == number) return true;
      if (Now() - start > kDeadline) return false;
    }
  }

  static Numbers Seen(ContractPeer& peer, const std::string& type) {
    Numbers all;
    for (const auto& [key, numbers] : SeenByKey(peer, type)) {
      all.insert(all.end(), numbers.begin(), numbers.end());
    }
    return all;
  }

  // From now on a callback of the reader waits, for the message `number` from `writer`.
  static void HoldWith(ContractPeer& reader, ContractPeer& writer, const std::string& type,
                       uint64_t number) {
    ASSERT_EQ(reader.Ask("hold " + type), "ok");
    Write(writer, type, number, number);
    ASSERT_EQ(reader.Ask("waiting " + type + " 20000"), "yes");
  }

  // Writes FIRST and on until a write is refused; returns the number that was.
  static uint64_t WriteUntilRefused(ContractPeer& writer, const std::string& type, uint64_t first,
                                    size_t bytes) {
    constexpr uint64_t kEnough = 100;
    for (uint64_t n = first; n < first + kEnough; ++n) {
      const std::string answer = writer.Ask(fmt::format("try {} {} {}", type, n, bytes));
      if (answer.starts_with("refused ")) return n;
      EXPECT_THAT(answer, StartsWith("sent "));
    }
    ADD_FAILURE() << "no write was refused";
    return 0;
  }

  const std::unique_ptr<ContractNetwork> network_ = GetParam().make();
};

// ---- Reliable

TEST_P(ContractTest, MessagesArriveAsTheyWereWritten) {
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

TEST_P(ContractTest, EverySampleArrivesOnceInTheOrderOfItsWriter) {
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

TEST_P(ContractTest, AWriterAndAReaderOfOneHubMatchToo) {
  const Peer replay = Join(Role::kReplay);
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*replay, "TransitionChunk", 2);
  Write(*replay, "TransitionChunk", 1, 20);
  ExpectReceived(*replay, "TransitionChunk", 20);
}

// ---- History

TEST_P(ContractTest, AReaderThatIsBehindGetsTheNewestSampleOfEachKey) {
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

TEST_P(ContractTest, TheLastNOfEachKeyAreKept) {
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

TEST_P(ContractTest, AWriterThatKeepsTheLastIsNeverRefused) {
  const Peer learner = Join(Role::kLearner), actor = Join(Role::kActor);
  Connect(*learner, *actor, "WeightsPart");
  HoldWith(*actor, *learner, "WeightsPart", 1);
  for (uint64_t key = 0; key < 40; ++key) {
    EXPECT_THAT(learner->Ask(fmt::format("write WeightsPart {} 1 1000000 {}", key + 2, key)),
                StartsWith("wrote 1 refused 0 "));
  }
}

TEST_P(ContractTest, ARefusedSampleReachesNobodyAndIsWrittenAgain) {
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

TEST_P(ContractTest, AWriteWaitsForRoomAndIsRefusedAfterMaxBlocking) {
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

TEST_P(ContractTest, AWaitingWriteGoesOnWhenTheReaderHasTakenSomething) {
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

TEST_P(ContractTest, AWaitingWriteGoesOnWhenTheReaderEnds) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  HoldWith(*replay, *actor, "TransitionChunk", 1);
  const uint64_t next = WriteUntilRefused(*actor, "TransitionChunk", 2, 500'000);
  EXPECT_EQ(replay->Ask("unsubscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("release TransitionChunk"), "ok");
  Write(*actor, "TransitionChunk", next, next + 20, 500'000);
}

TEST_P(ContractTest, TheBoundIsThatOfOneWriter) {
  const Peer replay = Join(Role::kReplay), first = Join(Role::kActor), second = Join(Role::kActor);
  Connect(*first, *replay, "TransitionChunk");
  EXPECT_EQ(second->Ask("publish TransitionChunk"), "ok");
  ExpectMatched(*second, "TransitionChunk", 1);
  HoldWith(*replay, *first, "TransitionChunk", 1);
  WriteUntilRefused(*first, "TransitionChunk", 2, 500'000);
  EXPECT_THAT(second->Ask("try TransitionChunk 1 500000"), StartsWith("sent "));
}

TEST_P(ContractTest, ASampleAboveTheBoundIsSentWhenNothingIsUnread) {
  const Peer replay = Join(Role::kReplay), actor = Join(Role::kActor);
  Connect(*actor, *replay, "TransitionChunk");
  EXPECT_THAT(actor->Ask("try TransitionChunk 1 5000000"), StartsWith("sent "));
  ExpectReceived(*replay, "TransitionChunk", 1);
}

// ---- Late joiners

TEST_P(ContractTest, ALateReaderGetsTheLastNSamplesOfEachKey) {
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
  // The next sample arrives behind the old ones.
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

TEST_P(ContractTest, ATopicWithoutLateJoinersGivesNothingOld) {
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

// ---- Matching, liveness, restart

TEST_P(ContractTest, BothSidesCountTheirMatchesAlsoAfterAnEnd) {
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

TEST_P(ContractTest, APeerThatDiesWithoutAWordIsForgottenAndHoldsUpNobody) {
  if (!network_->CanKill()) GTEST_SKIP() << "a thread cannot die without its process";
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

TEST_P(ContractTest, ARestartedWriterHasNoHistoryButItsOwn) {
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
  // The next sample arrives behind anything old that there may be.
  ExpectMatched(*learner, "WeightsPart", 1);
  Write(*learner, "WeightsPart", 11, 11, 1000, "1");
  ExpectReceived(*actor, "WeightsPart", 2);
  EXPECT_THAT(SeenByKey(*actor, "WeightsPart"), ElementsAre(std::pair(1, Numbers{10, 11})));
}

// ---- Threads

TEST_P(ContractTest, ASlowCallbackDelaysItsPlaneOnly) {
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

TEST_P(ContractTest, CallbacksOfAReaderRunOneAtATime) {
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

TEST_P(ContractTest, ADestructorOfAReaderWaitsForItsCallback) {
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
TEST_P(ContractTest, AWriterCopiesThePayloadBeforeItReturns) {
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

TEST_P(ContractTest, AcknowledgementsWaitForEveryReader) {
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

TEST_P(ContractTest, MalformedListsEveryTopicThatWasRead) {
  const Peer replay = Join(Role::kReplay);
  EXPECT_EQ(replay->Ask("malformed"), "malformed");
  EXPECT_EQ(replay->Ask("subscribe TransitionChunk"), "ok");
  EXPECT_EQ(replay->Ask("subscribe SampleRequest"), "ok");
  EXPECT_EQ(replay->Ask("publish BatchPart"), "ok");
  EXPECT_EQ(replay->Ask("unsubscribe SampleRequest"), "ok");
  EXPECT_EQ(replay->Ask("unsubscribed SampleRequest 20000"), "yes");
  EXPECT_EQ(replay->Ask("malformed"), "malformed sample_request:0 transitions_v1:0");
}

INSTANTIATE_TEST_SUITE_P(Link, ContractTest,
                         ::testing::Values(Implementation{"Local", &MakeLocalContractNetwork},
                                           Implementation{"Dds", &MakeDdsContractNetwork}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace shoal::link

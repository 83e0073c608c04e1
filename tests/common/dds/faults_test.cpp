// SPDX-License-Identifier: Apache-2.0
// Processes that are killed, stopped, cut off or flooded with packets.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <memory>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/dds/bus.h"
#include "common/dds/host_network.h"
#include "tests/common/dds/peer_process.h"

namespace shoal::dds {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class FaultsTest : public ::testing::Test {
 protected:
  // An actor's writer and a replay's reader of chunks, matched.
  void Connect(PeerProcess& actor, PeerProcess& replay) {
    replay.Ask("subscribe TransitionChunk");
    actor.Ask("publish TransitionChunk");
    ASSERT_EQ(actor.Ask("match TransitionChunk 1 10000"), "matched 1");
  }

  PeerProcess coordinator_;
  const ClusterAddress address_ = coordinator_.address();
};

TEST_F(FaultsTest, ASecondCoordinatorIsRefusedNamingThePort) {
  try {
    const Bus second(address_, TransportConfig{}, Role::kCoordinator);
    FAIL() << "two coordinators in one domain";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(),
                HasSubstr(fmt::format("UDP port {} is taken", DiscoveryPort(address_.domain, 0))));
    EXPECT_THAT(error.what(), HasSubstr("coordinator"));
  }
}

TEST_F(FaultsTest, AKilledReplayIsFoundAgainOnItsPortAndForgottenAfterItsLease) {
  PeerProcess actor("actor", address_);
  auto replay = std::make_unique<PeerProcess>("replay", address_);
  Connect(actor, *replay);
  actor.Ask("show CreditsMessage");
  EXPECT_THAT(actor.Ask("write TransitionChunk 1 5 1000"), StartsWith("wrote 5 "));
  replay->Kill();
  replay = std::make_unique<PeerProcess>("replay", address_);
  const SteadyTime restarted = Now();
  replay->Ask("subscribe TransitionChunk");
  replay->Ask("publish CreditsMessage");
  replay->Ask("write CreditsMessage 9 1 0");
  // The credit of the new one arrives: from then on chunks reach it.
  EXPECT_THAT(actor.NextGot(), StartsWith("got CreditsMessage"));
  EXPECT_LT(SecondsSince(restarted), 8) << "lease of 4 s and a little";
  EXPECT_EQ(actor.Ask("match TransitionChunk 1 8000"), "matched 1") << "the dead one's lease ended";
  EXPECT_THAT(actor.Ask("write TransitionChunk 6 5 1000"), StartsWith("wrote 5 refused 0"));
  EXPECT_THAT(replay->Ask("received TransitionChunk 5 10000"), StartsWith("received 5 gaps 0"));
}

TEST_F(FaultsTest, WritesToAStoppedReaderAreRefusedInTimeAndNoneIsLost) {
  PeerProcess actor("actor", address_), replay("replay", address_);
  Connect(actor, replay);
  actor.Ask("write TransitionChunk 1 1 1000000");
  ASSERT_THAT(replay.Ask("received TransitionChunk 1 10000"), StartsWith("received 1 "));
  replay.Signal(SIGSTOP);
  uint64_t n = 2;
  std::string answer;
  do {
    answer = actor.Ask(fmt::format("try TransitionChunk {} 1000000", n++));
  } while (answer.starts_with("sent") && n < 100);
  replay.Signal(SIGCONT);
  ASSERT_THAT(answer, StartsWith("refused"));
  EXPECT_LT(std::stoi(answer.substr(8)), 2000) << "max_blocking is 200 ms";
  // The refused one is sent again under its number; the sequence has no hole.
  const uint64_t refused = n - 1;
  EXPECT_THAT(actor.Ask(fmt::format("write TransitionChunk {} 5 1000000", refused)),
              StartsWith("wrote 5 "));
  const uint64_t total = refused + 4;
  EXPECT_THAT(replay.Ask(fmt::format("received TransitionChunk {} 10000", total)),
              StartsWith(fmt::format("received {} gaps 0 ", total)));
}

TEST_F(FaultsTest, ACutShorterThanTheLeaseLosesNothing) {
  PeerProcess actor("actor", address_), replay("replay", address_);
  Connect(actor, replay);
  EXPECT_EQ(actor.Ask("deafmute 1000"), "ok");
  EXPECT_THAT(actor.Ask("write TransitionChunk 1 50 200000"), StartsWith("wrote 50 "));
  EXPECT_EQ(replay.Ask("received TransitionChunk 50 20000"),
            "received 50 gaps 0 bytes 10000000 malformed 0");
  EXPECT_EQ(actor.Ask("acknowledged TransitionChunk 5000"), "yes");
}

// Random bytes, and random bytes behind a genuine RTPS header, at every port of the run.
TEST_F(FaultsTest, GarbageDatagramsDisturbNobody) {
  PeerProcess learner("learner", address_), replay("replay", address_), actor("actor", address_);
  Connect(actor, replay);
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(fd, 0);
  Random random(1);
  constexpr char kHeader[] = "RTPS\x02\x01\x01\x10";
  for (int i = 0; i < 6000; ++i) {
    std::vector<uint8_t> datagram(random.Below(600));
    for (uint8_t& byte : datagram) byte = static_cast<uint8_t>(random.Next());
    if (i % 2 == 0 && datagram.size() >= 8) std::memcpy(datagram.data(), kHeader, 8);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const int port = DiscoveryPort(address_.domain + i % 2, static_cast<int>(random.Below(3))) +
                     static_cast<int>(random.Below(2));
    to.sin_port = htons(static_cast<uint16_t>(port));
    // A refused port (the coordinator has none in the batch domain) is fine.
    sendto(fd, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof(to));
  }
  close(fd);
  EXPECT_THAT(actor.Ask("write TransitionChunk 1 100 100000"), StartsWith("wrote 100 "));
  EXPECT_EQ(replay.Ask("received TransitionChunk 100 10000"),
            "received 100 gaps 0 bytes 10000000 malformed 0");
  replay.Ask("subscribe SampleRequest");
  learner.Ask("publish SampleRequest");
  EXPECT_EQ(learner.Ask("match SampleRequest 1 10000"), "matched 1");
  EXPECT_THAT(learner.Ask("write SampleRequest 1 10 0"), StartsWith("wrote 10 "));
  EXPECT_THAT(replay.Ask("received SampleRequest 10 10000"), StartsWith("received 10 gaps 0"));
}

}  // namespace
}  // namespace shoal::dds

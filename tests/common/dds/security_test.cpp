// SPDX-License-Identifier: Apache-2.0
// Secured domains: each role has only the permissions that it needs; strangers neither join nor
// read.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/if_ether.h>
#include <linux/if_packet.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/dds/bus.h"
#include "common/dds/domain_xml.h"
#include "common/dds/role_rights.h"
#include "tests/common/dds/exchange.h"
#include "tests/support/temporary_folder.h"

namespace shoal::dds {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class SecurityTest : public ::testing::Test {
 protected:
  // A folder of credentials from a separate authority.
  std::string Credentials(const std::string& name, const Validity& validity = ValidForDays(1)) {
    const auto folder = parent_.path() / name;
    CreateCredentials(folder, AllRoleRights(), validity);
    return folder.string();
  }

  TemporaryFolder parent_;
  const std::string secure_ = Credentials("secure");
  PeerProcess coordinator_{secure_};
  const ClusterAddress address_ = coordinator_.address();
};

TEST_F(SecurityTest, EachRoleExchangesItsMessages) {
  PeerProcess replay("replay", address_), learner("learner", address_), actor("actor", address_),
      eval("eval", address_);
  ExpectSame<TransitionChunk>(actor, replay, "TransitionChunk");
  ExpectSame<CreditsMessage>(replay, actor, "CreditsMessage");
  ExpectSame<SampleRequest>(learner, replay, "SampleRequest");
  ExpectSame<BatchSlot>(replay, learner, "BatchSlot");
  ExpectSame<BatchPart>(replay, learner, "BatchPart");
  ExpectSame<WeightsPart>(learner, actor, "WeightsPart");
  ExpectSame<EvalWeightsPart>(learner, eval, "EvalWeightsPart");
  ExpectSame<ActorMetrics>(actor, coordinator_, "ActorMetrics");
  ExpectSame<EvalMetrics>(eval, coordinator_, "EvalMetrics");
  ExpectSame<ReplayMetrics>(replay, coordinator_, "ReplayMetrics");
  ExpectSame<LearnerMetrics>(learner, coordinator_, "LearnerMetrics");
  ExpectSame<ReplayProgress>(replay, coordinator_, "ReplayProgress");
  ExpectSame<LearnerProgress>(learner, coordinator_, "LearnerProgress");
  ExpectSame<EvalMessage>(eval, coordinator_, "EvalMessage");
  ExpectSame<ControlMessage>(coordinator_, actor, "ControlMessage");
  ClusterAddress without_tag = address_;
  without_tag.tag = "-";
  PeerProcess client("client", without_tag);
  ExpectSame<RunViewMessage>(coordinator_, client, "RunViewMessage");
  ExpectSame<CommandMessage>(client, coordinator_, "CommandMessage");
}

// The stranger announces itself to the run all the time that the lawful actor needs to be matched,
// and two more seconds.
void ExpectKeptOut(PeerProcess& stranger, const ClusterAddress& run) {
  EXPECT_EQ(stranger.Ask("subscribe WeightsPart"), "ok");
  EXPECT_EQ(stranger.Ask("publish TransitionChunk"), "ok");
  PeerProcess learner("learner", run), replay("replay", run), actor("actor", run);
  EXPECT_EQ(learner.Ask("publish WeightsPart"), "ok");
  EXPECT_EQ(replay.Ask("subscribe TransitionChunk"), "ok");
  ExpectSame<WeightsPart>(learner, actor, "WeightsPart");
  EXPECT_EQ(stranger.Ask("match WeightsPart 1 2000"), "matched 0");
  EXPECT_EQ(stranger.Ask("match TransitionChunk 1 100"), "matched 0");
  EXPECT_EQ(learner.Ask("match WeightsPart 2 100"), "matched 1") << "the lawful actor alone";
  EXPECT_EQ(replay.Ask("match TransitionChunk 1 100"), "matched 0");
  EXPECT_THAT(stranger.Ask("received WeightsPart 1 100"), StartsWith("received 0 "));
}

// The library reads its configuration as XML, in which it replaces ${VARIABLES}.
TEST_F(SecurityTest, AFolderMayHaveCharactersOfXmlInItsName) {
  ClusterAddress address;
  address.secure = Credentials("<of> $HOME & 'others'");
  EXPECT_NO_THROW(ClaimDomain(TransportConfig{}, &address));
}

TEST_F(SecurityTest, AFolderThatTheLibraryCannotOpenIsRefusedByName) {
  for (const char* name : {"of ${HOME}", "back\\slash", "a \"quote\""}) {
    ClusterAddress address;
    address.secure = Credentials(name);
    try {
      ClaimDomain(TransportConfig{}, &address);
      ADD_FAILURE() << "opened " << name;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), AllOf(HasSubstr("folder"), HasSubstr(address.secure)));
      EXPECT_EQ(e.exit_code(), 2);
    }
  }
}

// Not that a port is taken: that is had by its own half of a domain.
TEST_F(SecurityTest, WhyADomainCannotBeJoinedIsSaidAsTheLibrarySaysIt) {
  ClusterAddress address;
  address.secure = Credentials("mixed");
  const std::filesystem::path folder = address.secure;
  std::filesystem::copy(folder / "learner.p7s", folder / "coordinator.p7s",
                        std::filesystem::copy_options::overwrite_existing);
  try {
    ClaimDomain(TransportConfig{}, &address);
    ADD_FAILURE() << "joined as a learner";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("cannot join DDS domain"), HasSubstr("coordinator")));
  }
}

TEST_F(SecurityTest, AProcessWithoutCredentialsNeitherJoinsNorReads) {
  ClusterAddress plain = address_;
  plain.secure.clear();
  PeerProcess stranger("actor", plain);
  ExpectKeptOut(stranger, address_);
}

TEST_F(SecurityTest, AProcessWithAnotherAuthoritysCredentialsNeitherJoinsNorReads) {
  ClusterAddress other = address_;
  other.secure = Credentials("other");
  PeerProcess stranger("actor", other);
  ExpectKeptOut(stranger, address_);
}

TEST_F(SecurityTest, AnActorsCredentialsDoNotLetItSendWeights) {
  PeerProcess actor("actor", address_);
  EXPECT_EQ(actor.Ask("publish TransitionChunk"), "ok");
  EXPECT_EQ(actor.Ask("publish WeightsPart"), "") << "it ends with an error";
}

// An actor may not send messages that decide about a run or show other roles: every host with
// actors has its key.
TEST_F(SecurityTest, AnActorsCredentialsSayNothingInTheNameOfAnotherRole) {
  for (const char* message : {"EvalMessage", "EvalMetrics", "ReplayMetrics", "LearnerMetrics",
                              "ReplayProgress", "LearnerProgress", "CreditsMessage"}) {
    PeerProcess actor("actor", address_);
    EXPECT_EQ(actor.Ask("publish ActorMetrics"), "ok");
    EXPECT_EQ(actor.Ask(std::string("publish ") + message), "") << message;
  }
  PeerProcess eval("eval", address_);
  EXPECT_EQ(eval.Ask("publish EvalMessage"), "ok");
  EXPECT_EQ(eval.Ask("publish TransitionChunk"), "") << "nor is a record the evaluation's";
}

// Everything that crosses the loopback interface while it lives.
class Eavesdropper {
 public:
  Eavesdropper() : fd_(socket(AF_PACKET, SOCK_DGRAM | SOCK_CLOEXEC, htons(ETH_P_IP))) {
    if (fd_ < 0) return;
    sockaddr_ll place{};
    place.sll_family = AF_PACKET;
    place.sll_protocol = htons(ETH_P_IP);
    place.sll_ifindex = static_cast<int>(if_nametoindex("lo"));
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    const int bytes = 16 << 20;
    setsockopt(fd_, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes);
  }
  ~Eavesdropper() {
    if (fd_ >= 0) close(fd_);
  }
  bool listens() const { return fd_ >= 0; }
  // Whether a packet that has come holds the bytes.
  bool Heard(std::span<const uint8_t> wanted) const {
    std::vector<uint8_t> packet(70'000);
    pollfd ready{.fd = fd_, .events = POLLIN, .revents = 0};
    while (poll(&ready, 1, 0) > 0) {
      const ssize_t size = recv(fd_, packet.data(), packet.size(), 0);
      if (size <= 0) return false;
      const auto end = packet.begin() + size;
      if (std::search(packet.begin(), end, wanted.begin(), wanted.end()) != end) return true;
    }
    return false;
  }

 private:
  int fd_;
};

// Whether the learner's messages to an actor are readable on the network.
bool WeightsAreReadable(const ClusterAddress& address) {
  const Eavesdropper eavesdropper;
  PeerProcess learner("learner", address), actor("actor", address);
  // A number of its own: other tests send the usual payload in the clear at the same time.
  const auto number = static_cast<uint64_t>(getpid()) * 1000 + 1;
  ExpectSame<WeightsPart>(learner, actor, "WeightsPart", number);
  const std::vector<uint8_t> payload = ExamplePayload(number, 100'000);  // ExpectSame's
  return eavesdropper.Heard(std::span(payload).first(64));
}

TEST_F(SecurityTest, NobodyOnTheNetworkReadsWhatIsSent) {
  if (!Eavesdropper().listens()) GTEST_SKIP() << "needs CAP_NET_RAW";
  const PeerProcess plain;
  EXPECT_TRUE(WeightsAreReadable(plain.address())) << "the check itself does not see anything";
  EXPECT_FALSE(WeightsAreReadable(address_));
}

// The line that a process which cannot join ends with.
std::string JoinError(const ClusterAddress& address) {
  try {
    const Bus bus(address, TransportConfig{}, Role::kActor);
    return "joined";
  } catch (const Error& e) {
    return e.what();
  }
}

TEST_F(SecurityTest, CredentialsThatDoNotServeAreNamed) {
  ClusterAddress address = address_;
  address.secure = Credentials("old", {.from = 0, .until = 1'000'000});
  EXPECT_THAT(JoinError(address), AllOf(HasSubstr("old/ca.pem"), HasSubstr("expired")));
  address.secure = "/absent";
  EXPECT_THAT(JoinError(address), HasSubstr("/absent/ca.pem"));
}

TEST_F(SecurityTest, ATemplateThatWouldLeaveSecurityOutIsRefused) {
  EXPECT_THROW(RenderDomainXml("<CycloneDDS/>", address_, {}, Role::kActor, Plane::kMain), Error);
}

}  // namespace
}  // namespace shoal::dds

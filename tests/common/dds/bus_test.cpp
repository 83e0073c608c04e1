// SPDX-License-Identifier: Apache-2.0
#include "common/dds/bus.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/dds/claim_domain.h"
#include "common/dds/domain_xml.h"
#include "common/dds/host_network.h"
#include "tests/support/temporary_folder.h"

namespace shoal::dds {
namespace {

using ::testing::HasSubstr;

// Holds a UDP port while it lives.
class PortHolder {
 public:
  explicit PortHolder(int port) : fd_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    address.sin_port = htons(static_cast<uint16_t>(port));
    EXPECT_EQ(bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0) << port;
  }
  ~PortHolder() { close(fd_); }
  PortHolder(const PortHolder&) = delete;
  PortHolder& operator=(const PortHolder&) = delete;

 private:
  int fd_;
};

// The message of the Error that joining throws.
std::string JoinError(const ClusterAddress& address, const TransportConfig& transport, Role role) {
  try {
    const Bus bus(address, transport, role);
    return "joined";
  } catch (const Error& error) {
    return error.what();
  }
}

// A domain that was free a moment ago.
ClusterAddress FreeAddress() {
  ClusterAddress address;
  ClaimDomain(TransportConfig{}, &address);
  return address;
}

// A domain that other tests leave alone, as its coordinator's port is held, and that a learner or
// replay of this one can join.
struct ReservedDomain {
  ClusterAddress address = FreeAddress();
  PortHolder coordinator{DiscoveryPort(address.domain, 0)};
};

TEST(ClaimDomain, TwoClaimsGetTwoEvenDomainsAndTags) {
  ClusterAddress first, second;
  const auto first_bus = ClaimDomain(TransportConfig{}, &first);
  const auto second_bus = ClaimDomain(TransportConfig{}, &second);
  EXPECT_NE(first.domain, second.domain);
  EXPECT_NE(first.tag, second.tag);
  for (const int domain : {first.domain, second.domain}) {
    EXPECT_EQ(domain % 2, 0);
    EXPECT_GE(domain, 2);
    EXPECT_LE(domain, 98);
  }
}

TEST(ClaimDomain, KeepsATagThatIsGiven) {
  ClusterAddress address;
  address.tag = "mine";
  const auto bus = ClaimDomain(TransportConfig{}, &address);
  EXPECT_EQ(address.tag, "mine");
}

TEST(ClaimDomain, ADomainIsTakenWhenAnyFixedPortOfItsPairIs) {
  const int domain = FreeAddress().domain;
  ASSERT_TRUE(RunPortsFree(domain));
  for (const int port :
       {DiscoveryPort(domain, 0), DiscoveryPort(domain, 2) + 1, DiscoveryPort(domain + 1, 0),
        DiscoveryPort(domain + 1, 1), DiscoveryPort(domain + 1, 2)}) {
    const PortHolder holder(port);
    EXPECT_FALSE(RunPortsFree(domain)) << port;
  }
  EXPECT_TRUE(RunPortsFree(domain));
}

TEST(ClaimDomain, AnInterfaceThatDoesNotExistEndsTheSearch) {
  TransportConfig transport;
  transport.interface = "nope0";
  ClusterAddress address;
  EXPECT_THROW(ClaimDomain(transport, &address), Error);
}

TEST(Bus, ATakenPortIsNamedInTheError) {
  const ReservedDomain domain;
  const ClusterAddress& address = domain.address;
  const int port = DiscoveryPort(address.domain, 1);
  const PortHolder holder(port);
  const std::string error = JoinError(address, TransportConfig{}, Role::kLearner);
  EXPECT_THAT(error, HasSubstr(fmt::format("UDP port {} is taken", port)));
  EXPECT_THAT(error, HasSubstr("learner"));
}

TEST(Bus, ATakenPortOfTheBatchDomainIsNamedToo) {
  const ReservedDomain domain;
  const ClusterAddress& address = domain.address;
  const int port = DiscoveryPort(address.domain + 1, 2);
  const PortHolder holder(port);
  EXPECT_THAT(JoinError(address, TransportConfig{}, Role::kReplay),
              HasSubstr(fmt::format("UDP port {} is taken", port)));
}

TEST(Bus, AnInterfaceThatDoesNotExistIsNamedWithThoseThatDo) {
  TransportConfig transport;
  transport.interface = "nope0";
  const std::string error = JoinError(FreeAddress(), transport, Role::kCoordinator);
  EXPECT_THAT(error, HasSubstr("\"nope0\""));
  EXPECT_THAT(error, HasSubstr("lo"));
  transport.interface = "192.0.2.1";  // reserved for documentation: no host has it
  EXPECT_THAT(JoinError(FreeAddress(), transport, Role::kCoordinator), HasSubstr("192.0.2.1"));
}

TEST(Bus, TheInterfaceMayBeGivenByItsAddress) {
  TransportConfig transport;
  transport.interface = "127.0.0.1";
  const ReservedDomain domain;
  EXPECT_EQ(JoinError(domain.address, transport, Role::kReplay), "joined");
}

TEST(Bus, AHostThatDoesNotResolveIsNamed) {
  ClusterAddress address = FreeAddress();
  address.host = "no-such-host.invalid";
  EXPECT_THAT(JoinError(address, TransportConfig{}, Role::kActor),
              HasSubstr("no-such-host.invalid"));
}

TEST(Bus, OddAndOutOfRangeDomainsAreRefused) {
  ClusterAddress address;
  address.tag = "t";
  for (const int domain : {-2, 3, 100}) {
    address.domain = domain;
    EXPECT_THAT(JoinError(address, TransportConfig{}, Role::kActor),
                HasSubstr(fmt::format("domain {}:", domain)));
  }
}

TEST(Bus, AProcessJoinsADomainOnce) {
  ClusterAddress address;
  const auto bus = ClaimDomain(TransportConfig{}, &address);
  EXPECT_THAT(JoinError(address, TransportConfig{}, Role::kActor), HasSubstr("already"));
}

TEST(Bus, ADomainCanBeJoinedAgainAfterItWasLeft) {
  const ReservedDomain domain;
  const ClusterAddress& address = domain.address;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(JoinError(address, TransportConfig{}, Role::kReplay), "joined") << i;
  }
}

TEST(Bus, WhatDdsSaysAboutABadOverrideIsPartOfTheError) {
  const ReservedDomain domain;
  const ClusterAddress& address = domain.address;
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "dds.xml";
  WriteFileAtomically(path,
                      "<CycloneDDS><Domain><General><NoSuchThing>1</NoSuchThing></General>"
                      "</Domain></CycloneDDS>");
  setenv(kOverrideVariable, path.c_str(), 1);
  const std::string error = JoinError(address, TransportConfig{}, Role::kReplay);
  unsetenv(kOverrideVariable);
  EXPECT_THAT(error, HasSubstr("NoSuchThing"));
}

}  // namespace
}  // namespace shoal::dds

// SPDX-License-Identifier: Apache-2.0
#include "common/dds/domain_xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/dds/host_network.h"
#include "tests/support/temporary_folder.h"

namespace shoal::dds {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const ClusterAddress kAddress{.domain = 4, .tag = "run-1", .host = "10.0.0.9"};

std::string Render(std::string_view xml, Role role, Plane plane = Plane::kMain) {
  return RenderDomainXml(xml, kAddress, TransportConfig{}, role, plane);
}

TEST(DomainXml, PortsFollowTheFormulaOfTheStandard) {
  EXPECT_EQ(DiscoveryPort(0, 0), 7410);
  EXPECT_EQ(DiscoveryPort(4, 2), 7400 + 1000 + 14);
  EXPECT_LT(DiscoveryPort(99, 2) + 1, 32768);  // below Linux's ephemeral ports
}

TEST(DomainXml, ServersHaveFixedIndicesAndActorsNone) {
  EXPECT_EQ(Render("@INDEX@", Role::kCoordinator), "0");
  EXPECT_EQ(Render("@INDEX@", Role::kLearner), "1");
  EXPECT_EQ(Render("@INDEX@", Role::kReplay), "2");
  EXPECT_EQ(Render("@INDEX@", Role::kActor), "none");
}

TEST(DomainXml, ActorsAnnounceThemselvesToTheThreeServers) {
  EXPECT_EQ(Render("@PEERS@", Role::kActor),
            "<Peers><Peer Address=\"10.0.0.9:8410\"/><Peer Address=\"10.0.0.9:8412\"/>"
            "<Peer Address=\"10.0.0.9:8414\"/></Peers>");
  EXPECT_EQ(Render("@PEERS@", Role::kCoordinator), "<Peers></Peers>");
}

TEST(DomainXml, LearnerAndReplayMeetWithoutTheCoordinatorInTheBatchDomain) {
  EXPECT_EQ(Render("@PEERS@", Role::kLearner, Plane::kBatch),
            "<Peers><Peer Address=\"10.0.0.9:8664\"/></Peers>");
  EXPECT_EQ(Render("@PEERS@", Role::kReplay, Plane::kBatch),
            "<Peers><Peer Address=\"10.0.0.9:8662\"/></Peers>");
  EXPECT_THAT(Render("@PEERS@", Role::kLearner), HasSubstr("10.0.0.9:8410"));
  EXPECT_THAT(Render("@PEERS@", Role::kLearner), HasSubstr("10.0.0.9:8414"));
  EXPECT_THAT(Render("@PEERS@", Role::kLearner), Not(HasSubstr("10.0.0.9:8412")));
}

TEST(DomainXml, ActorsMayHaveLessUnacknowledgedThanBulkWriters) {
  EXPECT_THAT(Render("@WATERMARKS@", Role::kActor), HasSubstr("<WhcHigh>2097152B</WhcHigh>"));
  EXPECT_THAT(Render("@WATERMARKS@", Role::kReplay), HasSubstr("<WhcHigh>8388608B</WhcHigh>"));
}

TEST(DomainXml, InterfaceMayBeANameOrAnAddress) {
  TransportConfig transport;
  transport.interface = "eth0";
  EXPECT_EQ(RenderDomainXml("@INTERFACE@", kAddress, transport, Role::kActor, Plane::kMain),
            "name=\"eth0\"");
  transport.interface = "10.0.0.3";
  EXPECT_EQ(RenderDomainXml("@INTERFACE@", kAddress, transport, Role::kActor, Plane::kMain),
            "address=\"10.0.0.3\"");
}

TEST(DomainXml, ValuesCannotBreakOutOfTheirElement) {
  ClusterAddress address = kAddress;
  address.tag = "<a&\"b\">";
  EXPECT_EQ(RenderDomainXml("@TAG@", address, TransportConfig{}, Role::kActor, Plane::kMain),
            "&lt;a&amp;&quot;b&quot;&gt;");
}

TEST(DomainXml, FillsEveryPlaceholderOfTheBuiltInTemplate) {
  TransportConfig transport;
  transport.fragment_bytes = 8000;
  const std::string xml =
      RenderDomainXml(BuiltInTemplate(), kAddress, transport, Role::kReplay, Plane::kMain);
  EXPECT_THAT(xml, Not(HasSubstr("@")));
  EXPECT_THAT(xml, HasSubstr("<FragmentSize>8000B</FragmentSize>"));
  EXPECT_THAT(xml, HasSubstr("<Tag>run-1</Tag>"));
  EXPECT_THAT(xml, HasSubstr("<ParticipantIndex>2</ParticipantIndex>"));
}

TEST(DomainXml, AnUnknownPlaceholderIsRefusedByName) {
  try {
    Render("<Tag>@TAGG@</Tag>", Role::kActor);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("@TAGG@"));
    EXPECT_EQ(error.exit_code(), 2);
  }
}

TEST(DomainXml, OtherAtSignsStayAsTheyAre) {
  EXPECT_EQ(Render("a@b, c@d @TAG@ @@ @", Role::kActor), "a@b, c@d run-1 @@ @");
}

TEST(DomainXml, TheEnvironmentNamesAFileThatReplacesTheTemplate) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "dds.xml";
  WriteFileAtomically(path, "mine @INDEX@");
  setenv(kOverrideVariable, path.c_str(), 1);
  EXPECT_EQ(DomainTemplate(), "mine @INDEX@");
  setenv(kOverrideVariable, "/no/such/file.xml", 1);
  EXPECT_THROW(DomainTemplate(), Error);
  unsetenv(kOverrideVariable);
  EXPECT_EQ(DomainTemplate(), BuiltInTemplate());
}

}  // namespace
}  // namespace shoal::dds

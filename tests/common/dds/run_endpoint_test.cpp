// SPDX-License-Identifier: Apache-2.0
#include "common/dds/run_endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/dds/bus.h"
#include "tests/support/temporary_folder.h"

namespace shoal::dds {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class ReachTest : public ::testing::Test {
 protected:
  ReachTest() { WriteClusterAddress(run_.path(), {.domain = 40, .tag = "t", .host = "10.0.0.1"}); }
  RunEndpoint Find(const EndpointOptions& options) const {
    return FindEndpoint(run_.path(), {}, options);
  }
  std::string Mistake(const std::string& peer) const {
    try {
      Find({.peer = peer, .interface = ""});
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      return e.what();
    }
    return "";
  }
  TemporaryFolder run_;
};

TEST_F(ReachTest, WithoutOptionsIsWhatTheRunFolderSays) {
  const RunEndpoint endpoint = Find({});
  EXPECT_EQ(endpoint.address.host, "10.0.0.1");
  EXPECT_EQ(endpoint.address.domain, 40);
  EXPECT_EQ(endpoint.transport.interface, TransportConfig().interface);
}

TEST_F(ReachTest, APeerReplacesTheHostAndItsPortTheDomain) {
  EXPECT_EQ(Find({.peer = "gate", .interface = ""}).address.host, "gate");
  EXPECT_EQ(Find({.peer = "gate", .interface = ""}).address.domain, 40);
  const std::string port = std::to_string(OperatePort({.domain = 42, .tag = "", .host = ""}));
  const RunEndpoint endpoint = Find({.peer = "10.0.0.9:" + port, .interface = "eth1"});
  EXPECT_EQ(endpoint.address.host, "10.0.0.9");
  EXPECT_EQ(endpoint.address.domain, 42);
  EXPECT_EQ(endpoint.address.tag, "t");
  EXPECT_EQ(endpoint.transport.interface, "eth1");
}

TEST_F(ReachTest, RefusesAPortThatIsNoCoordinators) {
  EXPECT_THAT(Mistake("gate:80"), AllOf(HasSubstr("gate:80"), HasSubstr("HOST:PORT")));
  EXPECT_THAT(Mistake("gate:7410x"), HasSubstr("gate:7410x"));
  EXPECT_THAT(Mistake(":7410"), HasSubstr("HOST"));
}

}  // namespace
}  // namespace shoal::dds

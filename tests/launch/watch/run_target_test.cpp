// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/dds/bus.h"
#include "launch/record/run_folder.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;

class RunTargetTest : public ::testing::Test {
 protected:
  // A run in the folder; it is running while the result lives.
  RunFolder Begin(const std::string& name) const {
    RunFolder run = RunFolder::Create(dir_.path(), name, false);
    RunConfig config;
    config.config.run_name = name;
    WriteRunConfig(run.path(), config);
    WriteClusterAddress(run.path(), {.domain = 6, .tag = "t-" + name, .host = "127.0.0.1"});
    return run;
  }
  RunTarget Resolve(const std::string& run) const {
    return ResolveTarget({.run = run, .peer = "", .run_dir = dir_.path().string()});
  }
  std::string Refusal(const std::string& run, int exit_code) const {
    try {
      return "took " + Resolve(run).name;
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), exit_code) << e.what();
      return e.what();
    }
  }
  const TemporaryFolder dir_;
};

TEST_F(RunTargetTest, TakesTheOnlyRunningRun) {
  Begin("over");
  const RunFolder running = Begin("on");
  EXPECT_EQ(Resolve("").name, "on");
  EXPECT_EQ(Resolve("").address.domain, 6);
  EXPECT_EQ(Resolve("on").folder, std::filesystem::canonical(running.path()));
  EXPECT_EQ(Resolve(running.path().string()).name, "on");
}

TEST_F(RunTargetTest, NoneSeveralAbsentAndEndedRunsAreRefusedByName) {
  EXPECT_THAT(Refusal("", 1), HasSubstr("no run is running in '" + dir_.path().string()));
  const RunFolder a = Begin("a"), b = Begin("b");
  EXPECT_THAT(Refusal("", 2), HasSubstr("a, b"));
  Begin("over");
  EXPECT_THAT(Refusal("over", 1), HasSubstr("over' is not running"));
  EXPECT_THAT(Refusal("nope", 2), HasSubstr("no run 'nope'"));
}

TEST_F(RunTargetTest, ARunThatHasNoAddressYetIsStarting) {
  const RunFolder run = Begin("young");
  std::filesystem::remove(run.path() / "cluster.json");
  EXPECT_THAT(Refusal("young", 1), HasSubstr("run 'young' is starting and cannot be reached yet"));
}

TEST(Peer, TheAddressShownIsTheAddressTaken) {
  const ClusterAddress address{.domain = 12, .tag = "secret", .host = "127.0.0.1"};
  const std::string peer = fmt::format("127.0.0.1:{}", dds::OperatePort(address));
  const RunTarget target = ResolveTarget({.run = "", .peer = peer});
  EXPECT_EQ(target.address.domain, 12);
  EXPECT_EQ(target.address.host, "127.0.0.1");
  EXPECT_EQ(target.transport.interface, "127.0.0.1");
}

TEST(Peer, OtherFormsAreRefused) {
  for (const char* peer : {"", "host", "host:", ":10660", "host:80", "host:10661", "host:10660x"}) {
    EXPECT_THROW(dds::ParsePeer(peer), Error) << peer;
  }
  EXPECT_THROW(ResolveTarget({.run = "a", .peer = "127.0.0.1:10660"}), Error);
  EXPECT_THROW(dds::InterfaceTowards("no-such-host.invalid"), Error);
}

}  // namespace
}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/hosts_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "launch/processes/process_plan.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class HostsFileTest : public ::testing::Test {
 protected:
  Hosts Read(const std::string& text) const {
    WriteFileAtomically(file_, text);
    return ReadHostsFile(file_);
  }
  // A file with these servers and hosts.
  Hosts Read(const std::string& servers, const std::string& hosts) const {
    return Read(R"({"schema": "shoal-hosts-1", "servers": )" + servers + R"(, "hosts": )" + hosts +
                "}");
  }
  std::string Mistake(const std::string& servers, const std::string& hosts) const {
    try {
      Read(servers, hosts);
    } catch (const Error& e) {
      EXPECT_EQ(e.exit_code(), 2);
      return e.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "hosts.json";
};

constexpr char kServers[] = R"({"address": "10.0.0.1"})";

TEST_F(HostsFileTest, DefaultsToSshByNameAndThisProgramsFolder) {
  const Hosts hosts = Read(kServers, R"([{"name": "far", "actors": 3}])");
  EXPECT_EQ(hosts.address, "10.0.0.1");
  EXPECT_EQ(hosts.actors_here, -1);
  EXPECT_EQ(hosts.RemoteActors(), 3);
  const RemoteHost& far = hosts.hosts.at(0);
  EXPECT_THAT(far.ssh,
              ElementsAre("ssh", "-o", "BatchMode=yes", "-o", "ServerAliveInterval=5", "far"));
  EXPECT_EQ(far.programs, ProgramFolder());
  EXPECT_EQ(far.interface, "auto");
  EXPECT_FALSE(far.shared);
}

TEST_F(HostsFileTest, WritesWhatItReads) {
  Hosts hosts = Read(R"({"address": "10.0.0.1", "interface": "eth0", "actors": 0})",
                     R"([{"name": "a", "actors": 1, "shared": true, "programs": "/opt/bin"},
                         {"name": "b", "actors": 2, "ssh": ["rsh", "b"], "interface": "ib0"}])");
  hosts.hosts[1].run = "/home/u/.shoal/x";
  WriteHostsFile(folder_.path() / "copy.json", hosts);
  const Hosts copy = ReadHostsFile(folder_.path() / "copy.json");
  EXPECT_EQ(copy.interface, "eth0");
  EXPECT_EQ(copy.actors_here, 0);
  ASSERT_EQ(copy.hosts.size(), 2u);
  EXPECT_TRUE(copy.hosts[0].shared);
  EXPECT_EQ(copy.hosts[0].programs, "/opt/bin");
  EXPECT_THAT(copy.hosts[1].ssh, ElementsAre("rsh", "b"));
  EXPECT_EQ(copy.hosts[1].interface, "ib0");
  EXPECT_EQ(copy.hosts[1].run, "/home/u/.shoal/x");
}

TEST_F(HostsFileTest, RefusesEveryMistakeByName) {
  const std::string good = R"([{"name": "a", "actors": 1}])";
  EXPECT_THAT(Mistake(R"({"adress": "10.0.0.1"})", good),
              HasSubstr("'servers.address' is missing"));
  EXPECT_THAT(Mistake(R"({"address": "h", "port": 1})", good), HasSubstr("'servers.port'"));
  EXPECT_THAT(Mistake(kServers, "[]"), HasSubstr("'hosts' = []"));
  EXPECT_THAT(Mistake(kServers, R"([{"name": "a"}])"), HasSubstr("'hosts[0].actors' is missing"));
  EXPECT_THAT(Mistake(kServers, R"([{"name": "a", "actors": 0}])"),
              AllOf(HasSubstr("'hosts[0].actors' = 0"), HasSubstr("1 to 1024")));
  EXPECT_THAT(Mistake(kServers, R"([{"name": "a", "actors": 1, "ssh": "ssh a"}])"),
              AllOf(HasSubstr("'hosts[0].ssh'"), HasSubstr("a list of words")));
  EXPECT_THAT(Mistake(kServers, R"([{"name": "a", "actors": 1, "programs": "bin"}])"),
              HasSubstr("an absolute path"));
  EXPECT_THAT(Mistake(kServers, R"([{"name": "a", "actors": 1}, {"name": "a", "actors": 1}])"),
              HasSubstr("'hosts[1].name'"));
  EXPECT_THAT(Mistake(kServers, R"([{"name": "a", "actors": 1, "actors": 2}])"),
              HasSubstr("duplicate key"));
  EXPECT_THROW(Read(R"({"schema": "shoal-hosts-2"})"), Error);
}

}  // namespace
}  // namespace shoal::launch

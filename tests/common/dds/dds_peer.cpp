// SPDX-License-Identifier: Apache-2.0
// The other process of tests of the link: joins a domain in a role and carries out the commands
// that it reads from stdin, one answer line on stdout for each
// (tests/common/link/peer_commands.h).
//
//   dds_peer ROLE DOMAIN TAG [SECURE]   says "joined"
//   dds_peer claim [SECURE]             is the coordinator of a free domain; "joined DOMAIN TAG"
//
// SECURE is a folder of credentials. Further commands:
//
//   deafmute MS                drops everything in and out; "ok"
//   quit                       ends
#include <dds/dds.h>
#include <sys/prctl.h>

#include <csignal>
#include <iostream>
#include <map>
#include <mutex>
#include <sstream>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "common/dds/bus_impl.h"
#include "tests/common/link/peer_commands.h"

namespace shoal::dds {
namespace {

using std::chrono::milliseconds;

std::mutex output_mutex;
void Say(const std::string& line) {
  const std::lock_guard lock(output_mutex);
  std::cout << line << std::endl;
}

// Cuts the network for a time, in all domains of the bus: drops received and sent packets. From
// outside of the process this would require root.
void CutOff(Bus& bus, milliseconds duration) {
  const Bus::Impl& impl = bus.impl();
  for (const Entity* domain : {&impl.main_domain, &impl.batch_domain, &impl.operate_domain}) {
    if (!*domain) continue;
    const dds_return_t result = dds_domain_set_deafmute(domain->get(), /*deaf=*/true, /*mute=*/true,
                                                        DDS_MSECS(duration.count()));
    CHECK(result == DDS_RETCODE_OK) << dds_strretcode(-result);
  }
}

void Serve(Bus& bus) {
  link::PeerCommands commands(bus, &Say);
  for (std::string line; std::getline(std::cin, line) && line != "quit";) {
    std::istringstream words(line);
    std::string verb;
    int64_t duration = 0;
    if (words >> verb >> duration && verb == "deafmute") {
      CutOff(bus, milliseconds(duration));
      Say("ok");
    } else {
      Say(commands.Run(line));
    }
  }
}

std::unique_ptr<Bus> Join(const std::vector<std::string>& arguments) {
  static const std::map<std::string, Role> kRoles = {{"coordinator", Role::kCoordinator},
                                                     {"learner", Role::kLearner},
                                                     {"replay", Role::kReplay},
                                                     {"actor", Role::kActor},
                                                     {"eval", Role::kEval},
                                                     {"client", Role::kClient}};
  ClusterAddress address;
  std::unique_ptr<Bus> bus;
  const size_t count = arguments.size();
  if ((count == 1 || count == 2) && arguments[0] == "claim") {
    if (count == 2) address.secure = arguments[1];
    bus = ClaimDomain(TransportConfig{}, &address);
    Say(fmt::format("joined {} {}", address.domain, address.tag));
  } else if ((count == 3 || count == 4) && kRoles.contains(arguments[0])) {
    if (count == 4) address.secure = arguments[3];
    address.domain = std::stoi(arguments[1]);
    address.tag = arguments[2];
    bus = std::make_unique<Bus>(address, TransportConfig{}, kRoles.at(arguments[0]));
    Say("joined");
  } else {
    throw UsageError("usage: dds_peer ROLE DOMAIN TAG [SECURE] | dds_peer claim [SECURE]");
  }
  return bus;
}

int Run(int argc, char** argv) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  TuneMalloc();
  const std::unique_ptr<Bus> bus = Join({argv + 1, argv + argc});
  Serve(*bus);
  return 0;
}

}  // namespace
}  // namespace shoal::dds

int main(int argc, char** argv) {
  return shoal::GuardMain("dds_peer", [&] { return shoal::dds::Run(argc, argv); });
}

// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmark/forked_processes.h"

#include <sys/prctl.h>

#include <csignal>

#include "common/base/main_guard.h"
#include "common/dds/bus.h"

namespace shoal::bench {

pid_t Fork(const char* name, const std::function<void()>& body) {
  const pid_t child = fork();
  if (child < 0) throw RuntimeError("fork: {}", std::strerror(errno));
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    _exit(GuardMain(name, [&] {
      body();
      return 0;
    }));
  }
  return child;
}

Meeting FreeMeeting(const TransportConfig& transport) {
  ClusterAddress address;
  dds::ClaimDomain(transport, &address).reset();
  Meeting meeting{.domain = address.domain};
  std::strncpy(meeting.tag, address.tag.c_str(), sizeof meeting.tag - 1);
  return meeting;
}

ClusterAddress AddressOf(const Meeting& meeting) {
  ClusterAddress address;
  address.domain = meeting.domain;
  address.tag = meeting.tag;
  return address;
}

RunConfig TwoCameraRun(const std::string& name) {
  RunConfig run;
  run.config.run_name = name;
  run.config.task = "Test";
  run.spec.task = "Test";
  run.spec.cameras = {"front", "side"};
  run.spec.channels = 6;
  run.spec.height = run.spec.width = 84;
  run.spec.action_size = 4;
  run.spec.model_fingerprint = "none";
  return run;
}

}  // namespace shoal::bench

// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/run_hosts.h"

#include "common/base/error.h"
#include "common/config/config_io.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

void Fetch(const fs::path& run, const Config& config, const Hosts& hosts, size_t index,
           const std::function<void(const std::string&)>& say, const StopQuestion& stop) {
  try {
    FetchSequenceLogs(hosts.hosts[index], ActorsOf(config, hosts.hosts, index), run, stop);
  } catch (const Error& e) {
    say(fmt::format("warning: {}", e.what()));
  }
}

}  // namespace

void ApplyHosts(const Hosts& hosts, Config* config) {
  const int here = hosts.actors_here >= 0 ? hosts.actors_here : config->actors;
  ApplyAssignments({fmt::format("actors={}", here + hosts.RemoteActors())}, config);
  TransportConfig& transport = config->transport;
  if (!hosts.interface.empty()) {
    transport.interface = hosts.interface;
  } else if (transport.interface == "lo") {
    transport.interface = "auto";
  }
  Validate(*config);
}

void CheckResumedHosts(const Hosts& hosts, const Config& config) {
  const int here = config.actors - hosts.RemoteActors();
  if (here < 0 || (hosts.actors_here >= 0 && here != hosts.actors_here)) {
    throw UsageError("the run has {} actors: the hosts' {} and {} here do not make that sum",
                     config.actors, hosts.RemoteActors(), std::max(0, hosts.actors_here));
  }
}

void CheckHosts(const Hosts& hosts, const StopQuestion& stop) {
  for (const RemoteHost& host : hosts.hosts) CheckHost(host, stop);
}

void PushToHosts(const fs::path& run, const Config& config, const std::string& tag, Hosts* hosts,
                 const std::function<void(const std::string&)>& say, const StopQuestion& stop) {
  for (size_t i = 0; i < hosts->hosts.size(); ++i) {
    RemoteHost& host = hosts->hosts[i];
    if (host.shared) {
      host.run = fs::absolute(run);
    } else if (host.run.empty()) {
      host.run = host.folder / fmt::format("{}-{}", config.run_name, tag);
    } else {
      Fetch(run, config, *hosts, i, say, stop);
    }
    PushRun(run, ActorsOf(config, hosts->hosts, i), &host, stop);
    WriteHostsFile(HostsFile(run), *hosts);
  }
}

void FetchFromHosts(const fs::path& run, const Config& config, const Hosts& hosts,
                    const std::function<void(const std::string&)>& say, const StopQuestion& stop) {
  for (size_t i = 0; i < hosts.hosts.size(); ++i) Fetch(run, config, hosts, i, say, stop);
}

fs::path HostsFile(const fs::path& run) { return run / kHostsFile; }

}  // namespace shoal::launch

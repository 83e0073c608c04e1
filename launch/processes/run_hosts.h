// SPDX-License-Identifier: Apache-2.0
// The other hosts of a run, from the command line to the fetched sequence logs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/config/config.h"
#include "launch/processes/hosts_file.h"
#include "launch/processes/remote_host.h"

namespace shoal::launch {

// Adds the number of the hosts' actors to config->actors, the number of this host's actors. Makes
// the servers reachable from the hosts. Throws Error (usage) if the sum is not a valid number of
// actors.
void ApplyHosts(const Hosts& hosts, Config* config);

// Throws Error (usage) if `hosts` would change the number of actors, because a resumed run keeps
// this number.
void CheckResumedHosts(const Hosts& hosts, const Config& config);

// Calls CheckHost for each host.
void CheckHosts(const Hosts& hosts, const StopQuestion& stop);

// Copies the run, whose config.json and cluster.json must exist, to each host, and stores the run's
// path on each host in RUN/hosts.json. `tag` distinguishes runs of the same name. Before the copy,
// fetches the sequence logs that an earlier session of the run left on the host; `say` gets a line
// for each failed fetch. Throws Error naming the host.
void PushToHosts(const std::filesystem::path& run, const Config& config, const std::string& tag,
                 Hosts* hosts, const std::function<void(const std::string&)>& say,
                 const StopQuestion& stop);

// Calls FetchSequenceLogs for each host. After a failure, `say` gets a line, and the function
// continues with the next host.
void FetchFromHosts(const std::filesystem::path& run, const Config& config, const Hosts& hosts,
                    const std::function<void(const std::string&)>& say, const StopQuestion& stop);

// RUN/hosts.json.
std::filesystem::path HostsFile(const std::filesystem::path& run);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// The other hosts of a run, from the command line to the fetched counters.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "common/config/config.h"
#include "launch/processes/hosts_file.h"
#include "launch/processes/remote_host.h"

namespace shoal::launch {

// Adds the hosts' actors to config->actors, which held the number of this host, and makes the
// servers reachable from the hosts. Throws Error (usage) if the sum is not a valid number of
// actors.
void ApplyHosts(const Hosts& hosts, Config* config);

// A resumed run keeps its number of actors: throws Error (usage) unless `hosts` fits it.
void CheckResumedHosts(const Hosts& hosts, const Config& config);

// Calls CheckHost for each host.
void CheckHosts(const Hosts& hosts, const StopQuestion& stop);

// Copies the run, whose config.json and cluster.json must exist, to each host, and stores its path
// there in RUN/hosts.json. `tag` distinguishes runs of one name. First fetches the counter pages
// that an earlier session of the run left on the host; `say` gets a line for each failure. Throws
// Error naming the host.
void PushToHosts(const std::filesystem::path& run, const Config& config, const std::string& tag,
                 Hosts* hosts, const std::function<void(const std::string&)>& say,
                 const StopQuestion& stop);

// Calls FetchSequenceLogs for each host. `say` gets a line for each failure, and the next host
// follows.
void FetchFromHosts(const std::filesystem::path& run, const Config& config, const Hosts& hosts,
                    const std::function<void(const std::string&)>& say, const StopQuestion& stop);

// RUN/hosts.json.
std::filesystem::path HostsFile(const std::filesystem::path& run);

}  // namespace shoal::launch

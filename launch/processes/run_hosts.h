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

// Counts the hosts' actors into config->actors, which said those of this host, and makes the
// servers reachable from them. Throws Error (usage) when the sum is no valid number of actors.
void ApplyHosts(const Hosts& hosts, Config* config);

// A resumed run keeps its number of actors: throws Error (usage) unless `hosts` fits it.
void CheckResumedHosts(const Hosts& hosts, const Config& config);

// CheckHost for each of them.
void CheckHosts(const Hosts& hosts, const StopQuestion& stop);

// Brings the run, whose config.json and cluster.json are written, to each host and stores in RUN's
// hosts.json where it lies there; `tag` keeps runs of one name apart. Pages that an earlier session
// of the run left there are fetched first; what cannot be is said. Throws Error naming the host.
void PushToHosts(const std::filesystem::path& run, const Config& config, const std::string& tag,
                 Hosts* hosts, const std::function<void(const std::string&)>& say,
                 const StopQuestion& stop);

// FetchSequenceLogs of each host; a failure is said and goes on with the next one.
void FetchFromHosts(const std::filesystem::path& run, const Config& config, const Hosts& hosts,
                    const std::function<void(const std::string&)>& say, const StopQuestion& stop);

// RUN/hosts.json.
std::filesystem::path HostsFile(const std::filesystem::path& run);

}  // namespace shoal::launch

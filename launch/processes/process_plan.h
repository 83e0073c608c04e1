// SPDX-License-Identifier: Apache-2.0
// Which programs a run consists of and how each is started.
#pragma once

#include <filesystem>
#include <vector>

#include "common/config/config.h"
#include "launch/processes/child_process.h"
#include "launch/processes/remote_host.h"

namespace shoal::launch {

// The folder of this program: the others lie beside it.
std::filesystem::path ProgramFolder();

// PROGRAM of that folder with arguments and the environment every program of ours runs in:
// `threads` for its computations, no spinning OpenMP threads, no render threads.
ProcessSpec ProgramSpec(const std::string& program, std::vector<std::string> arguments,
                        int threads);

// Replay (none of a run that learns on policy), learner, actors and evaluation actor of a run, in
// starting order. `config` is resolved (actors and learner.threads above 0); hosts whose run folder
// is known run the actors that ActorsOf says.
std::vector<ProcessSpec> PlanProcesses(const Config& config, const std::filesystem::path& run,
                                       const std::vector<RemoteHost>& hosts = {});

// The actors of hosts[index]: their numbers follow those of the hosts before it, which follow those
// of this host. config.actors counts them all.
ActorRange ActorsOf(const Config& config, const std::vector<RemoteHost>& hosts, size_t index);

// One training actor of this host, expendable.
ProcessSpec ActorProcess(const std::filesystem::path& run, int id);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// The programs of a run, and how each program is started.
#pragma once

#include <filesystem>
#include <vector>

#include "common/config/config.h"
#include "common/link/run_topology.h"
#include "launch/processes/child_process.h"
#include "launch/processes/remote_host.h"

namespace shoal::launch {

// The folder of this program and of the other programs.
std::filesystem::path ProgramFolder();

// Describes the start of `program` in ProgramFolder() with these arguments. The environment is that
// of every Shoal program: `threads` threads for computation, no spinning OpenMP threads, no render
// threads.
ProcessSpec ProgramSpec(const std::string& program, std::vector<std::string> arguments,
                        int threads);

// The program of this configuration's actors: shoal-actor or, if env.id names an environment of
// Python, the interpreter env.python with the package shoal_rl.
ProcessSpec ActorSpec(const Config& config, std::vector<std::string> arguments);

// The topology of a run with these hosts. `config` is resolved.
link::RunTopology TopologyOf(const Config& config, const std::vector<RemoteHost>& hosts);

// Describes the start of the children of a topology, in the topology's order. `config` is resolved
// (learner.threads above 0). `hosts` are the topology's hosts, with their run folders.
std::vector<ProcessSpec> PlanProcesses(const link::RunTopology& topology, const Config& config,
                                       const std::filesystem::path& run,
                                       const std::vector<RemoteHost>& hosts = {});

// The actors of hosts[index].
ActorRange ActorsOf(const Config& config, const std::vector<RemoteHost>& hosts, size_t index);

// Describes the start of training actor `id` on this host. The process is expendable.
ProcessSpec ActorProcess(const Config& config, const std::filesystem::path& run, int id);

}  // namespace shoal::launch

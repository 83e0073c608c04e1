// SPDX-License-Identifier: Apache-2.0
// Operations on another host through its ssh command: find the program, copy the files that an
// actor needs, run an actor, fetch the actor's files. No shared file system is needed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "launch/processes/child_process.h"
#include "launch/processes/hosts_file.h"

namespace shoal::launch {

// Called about ten times a second; true cancels the operation.
using StopQuestion = std::function<bool()>;

// Words as one command line of a POSIX shell.
std::string ShellLine(const std::vector<std::string>& words);

// Runs shoal-actor --version on the host. Throws Error naming the host if the host cannot be
// reached, or if the program is missing or has another version.
void CheckHost(const RemoteHost& host, const StopQuestion& stop);

// Actors `first` .. `first` + host.actors - 1 of a run.
struct ActorRange {
  int first = 0, count = 0;
  bool Holds(uint32_t id) const { return int(id) >= first && int(id) < first + count; }
};

// Copies the files that actors need to host->run, which becomes absolute: config.json,
// cluster.json, the DDS configuration of SHOAL_DDS_XML, an actor's credentials if the run is
// secured, and the sequence logs of these actors. A sequence log that exists on the host is not
// overwritten. Does nothing for a host that shares the run folder. Throws Error naming the host.
void PushRun(const std::filesystem::path& run, const ActorRange& actors, RemoteHost* host,
             const StopQuestion& stop);

// Copies the sequence logs of these actors from host.run to RUN/made. Throws Error naming the host.
void FetchSequenceLogs(const RemoteHost& host, const ActorRange& actors,
                       const std::filesystem::path& run, const StopQuestion& stop);

// Describes training actor `id` on the host as a child process of this process. The actor stops
// when its input is closed.
ProcessSpec RemoteActor(const RemoteHost& host, int id, const std::filesystem::path& run);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// The hosts of a run (schema shoal-hosts-1): the file that `shoal train --hosts FILE` reads, and
// hosts.json in the run folder. docs/cluster.md explains each key.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace shoal::launch {

// Another machine, which runs training actors of the run.
struct RemoteHost {
  std::string name;                // unique; names the host in messages
  int actors = 1;                  // at least 1
  std::vector<std::string> ssh;    // command; a shell command line is added as its last word
  std::filesystem::path programs;  // folder of shoal-actor there; absolute
  std::filesystem::path folder;    // folder for run folders there; relative = to the login's
  std::string interface = "auto";  // as transport.interface
  bool shared = false;  // has this host's run folder under the same path: nothing is copied
  std::filesystem::path secure;  // the actors' credentials there, once pushed; empty = as here
  std::filesystem::path run;     // the run's folder there, once created
};

struct Hosts {
  std::string address;    // at which every host reaches coordinator, learner and replay
  std::string interface;  // of this host; empty = transport.interface
  int actors_here = -1;   // -1 = the value of the key `actors`
  std::vector<RemoteHost> hosts;

  int RemoteActors() const;
};

// Throws Error: an unknown, duplicate, missing, ill-typed or out-of-range key is a usage error that
// names file and key.
Hosts ReadHostsFile(const std::filesystem::path& file);
void WriteHostsFile(const std::filesystem::path& file, const Hosts& hosts);

}  // namespace shoal::launch

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
  std::filesystem::path programs;  // folder of shoal-actor on the host; absolute
  std::filesystem::path folder;    // folder for runs on the host; relative to the login folder
  std::string interface = "auto";  // values as for transport.interface
  bool shared = false;  // shares the run folder with this host, same path: nothing is copied
  std::filesystem::path secure;  // folder of the actors' credentials on the host; empty = as here
  std::filesystem::path run;     // the run's folder on the host; empty before it is created
};

struct Hosts {
  std::string address;    // address of this host, at which other hosts reach the run's servers
  std::string interface;  // of this host; empty = transport.interface
  int actors_here = -1;   // -1 = the value of the key `actors`
  std::vector<RemoteHost> hosts;

  int RemoteActors() const;
};

// Throws Error. An unknown, duplicate, missing, ill-typed or out-of-range key gives a usage error
// that names file and key.
Hosts ReadHostsFile(const std::filesystem::path& file);
void WriteHostsFile(const std::filesystem::path& file, const Hosts& hosts);

}  // namespace shoal::launch

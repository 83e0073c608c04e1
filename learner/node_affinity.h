// SPDX-License-Identifier: Apache-2.0
// Keeps the threads of a learner process on one NUMA node while they fit there, so that none of
// them reads the memory of another socket.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "common/base/usable_cores.h"

namespace shoal::learner {

// Restricts and widens the affinity mask of the process's threads. The mask of the process when the
// object is made is the widest one. Does nothing if that mask has CPUs of one node only, and on a
// machine with one node or with more than 1,024 CPUs.
//
// Threads that run when the object is made, except the calling one, keep their masks: they receive
// messages, and would take cores from the threads that learn. Only the calling thread may use the
// object. Runs that share a machine are not coordinated: each learner takes the same node.
class NodeAffinity {
 public:
  // Reads the nodes below `root`, which is "/" except in tests.
  explicit NodeAffinity(std::filesystem::path root = "/");

  // Restricts the process to the node that has a core for each of `threads` threads (NodeFor in
  // numa_nodes.h); if there is none, lifts the restriction. Call it before these threads begin, and
  // before their number changes: they inherit the mask, and their memory is allocated near the CPU
  // that first writes it. Logs each change, and a warning if the nodes cannot be read.
  void FitTo(int threads);

  // Limits of the process as they are without the restriction.
  CoreLimits Limits() const;

 private:
  void Apply(const std::vector<int>& cpus);
  // Logs a line unless it equals the line before.
  void Say(const std::string& line);

  const std::filesystem::path root_;
  const std::set<pid_t> others_;  // threads that keep their masks
  std::vector<int> allowed_;      // CPUs without the restriction; empty: the system does not say
  std::vector<int> set_;          // CPUs of the calling thread, as last set or seen
  std::string said_;
};

}  // namespace shoal::learner

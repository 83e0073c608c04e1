// SPDX-License-Identifier: Apache-2.0
// The CPUs of this machine by NUMA node, and the node on which a group of threads fits. A socket
// has one node or several.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shoal {

struct NumaNode {
  int number = 0;
  std::vector<int> cpus;  // ascending; only CPUs that the process may use
  int cores = 0;          // physical cores that these CPUs belong to

  bool operator==(const NumaNode&) const = default;
};

// Parses a list of CPUs as Linux writes it, such as "0-7,16-23", and returns it in ascending order.
// A node that has memory alone has an empty list. Throws Error naming `source` if the text is no
// such list.
std::vector<int> ParseCpuList(std::string_view text, const std::string& source);

// Returns the nodes that have at least one of the `allowed` CPUs, by number; none if the system
// lists no nodes. CPUs of one core (hyper-threads) count as one core. Reads below `root`, which is
// "/" except in tests. Throws Error if the list of a node or of a core is absent or malformed.
std::vector<NumaNode> ReadNumaNodes(std::span<const int> allowed,
                                    const std::filesystem::path& root = "/");

// Returns the node with the most cores, or the first of several that have equally many. Null if
// this node has no core for each of `threads` threads, or if there are fewer than two nodes.
const NumaNode* NodeFor(int threads, std::span<const NumaNode> nodes);

}  // namespace shoal

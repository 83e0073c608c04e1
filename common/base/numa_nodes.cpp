// SPDX-License-Identifier: Apache-2.0
#include "common/base/numa_nodes.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>
#include <system_error>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal {
namespace {

namespace fs = std::filesystem;

constexpr int kMostCpus = 1 << 16;  // Linux supports fewer

// Takes a number from the front of the text; -1 if there is none below kMostCpus.
int TakeNumber(std::string_view* text) {
  int number = -1;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), number);
  if (error != std::errc() || number >= kMostCpus) return -1;
  text->remove_prefix(static_cast<size_t>(end - text->data()));
  return number;
}

std::vector<int> ReadCpuList(const fs::path& file) {
  return ParseCpuList(ReadFile(file), file.string());
}

// N of a folder "nodeN", else -1.
int NodeNumber(const std::string& name) {
  constexpr std::string_view kPrefix = "node";
  if (!name.starts_with(kPrefix)) return -1;
  std::string_view rest = std::string_view(name).substr(kPrefix.size());
  const int number = TakeNumber(&rest);
  return rest.empty() ? number : -1;
}

// Numbers of the nodes that the system lists, ascending.
std::set<int> NodeNumbers(const fs::path& folder) {
  std::set<int> numbers;
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, absent)) {
    const int number = NodeNumber(entry.path().filename().string());
    if (number >= 0) numbers.insert(number);
  }
  return numbers;
}

int CoresOf(const std::vector<int>& cpus, const fs::path& folder) {
  std::set<std::vector<int>> cores;
  for (const int cpu : cpus) {
    cores.insert(ReadCpuList(folder / fmt::format("cpu{}/topology/thread_siblings_list", cpu)));
  }
  return static_cast<int>(cores.size());
}

}  // namespace

std::vector<int> ParseCpuList(std::string_view text, const std::string& source) {
  const Error malformed =
      RuntimeError("'{}': '{}', expected a list of CPUs like 0-7,16-23", source, text);
  if (text.ends_with('\n')) text.remove_suffix(1);
  std::set<int> cpus;
  while (!text.empty()) {
    const int first = TakeNumber(&text);
    int last = first;
    if (text.starts_with('-')) {
      text.remove_prefix(1);
      last = TakeNumber(&text);
    }
    if (first < 0 || last < first) throw malformed;
    for (int cpu = first; cpu <= last; ++cpu) cpus.insert(cpu);
    if (text.empty()) break;
    if (!text.starts_with(',') || text.size() == 1) throw malformed;
    text.remove_prefix(1);
  }
  return {cpus.begin(), cpus.end()};
}

std::vector<NumaNode> ReadNumaNodes(std::span<const int> allowed, const fs::path& root) {
  const fs::path system = root / "sys/devices/system";
  std::vector<NumaNode> nodes;
  for (const int number : NodeNumbers(system / "node")) {
    NumaNode node;
    node.number = number;
    const std::vector<int> all = ReadCpuList(system / fmt::format("node/node{}/cpulist", number));
    std::ranges::set_intersection(all, allowed, std::back_inserter(node.cpus));
    if (node.cpus.empty()) continue;
    node.cores = CoresOf(node.cpus, system / "cpu");
    nodes.push_back(node);
  }
  return nodes;
}

const NumaNode* NodeFor(int threads, std::span<const NumaNode> nodes) {
  if (nodes.size() < 2) return nullptr;
  const auto largest = std::ranges::max_element(nodes, {}, &NumaNode::cores);
  return threads <= largest->cores ? &*largest : nullptr;
}

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
#include "learner/node_affinity.h"

#include <fmt/core.h>
#include <sched.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/numa_nodes.h"

namespace shoal::learner {
namespace {

namespace fs = std::filesystem;

// CPUs of the calling thread's mask, ascending. Empty on a machine with more CPUs than a cpu_set_t
// has.
std::vector<int> CpusOfMask() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cpus;
  if (sched_getaffinity(0, sizeof set, &set) != 0) return cpus;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(static_cast<size_t>(cpu), &set)) cpus.push_back(cpu);
  }
  return cpus;
}

// Sets the mask of one thread; 0 is the calling one. Returns whether the system did it.
bool SetMask(pid_t thread, const std::vector<int>& cpus) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (const int cpu : cpus) CPU_SET(static_cast<size_t>(cpu), &set);
  return sched_setaffinity(thread, sizeof set, &set) == 0;
}

std::set<pid_t> ThreadsOfProcess() {
  std::set<pid_t> threads;
  std::error_code absent;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc/self/task", absent)) {
    threads.insert(std::stoi(entry.path().filename().string()));
  }
  return threads;
}

std::set<pid_t> OtherThreads() {
  std::set<pid_t> threads = ThreadsOfProcess();
  threads.erase(gettid());
  return threads;
}

}  // namespace

NodeAffinity::NodeAffinity(fs::path root)
    : root_(std::move(root)), others_(OtherThreads()), allowed_(CpusOfMask()), set_(allowed_) {}

void NodeAffinity::FitTo(int threads) {
  // If another mask was set in the meantime, it is the limit from now on.
  if (const std::vector<int> now = CpusOfMask(); now != set_) allowed_ = set_ = now;
  std::vector<NumaNode> nodes;
  try {
    nodes = ReadNumaNodes(allowed_, root_);
  } catch (const Error& error) {
    log::Warning("the learner may use several NUMA nodes: {}", error.what());
  }
  const NumaNode* node = NodeFor(threads, nodes);
  const std::vector<int>& wanted = node == nullptr ? allowed_ : node->cpus;
  if (wanted != set_) Apply(wanted);
  if (set_ != wanted || nodes.size() < 2) return;
  if (node != nullptr) {
    Say(fmt::format("the learner stays on NUMA node {}: {} of {} CPUs", node->number,
                    node->cpus.size(), allowed_.size()));
  } else {
    Say(fmt::format("the learner uses all {} CPUs: no NUMA node has {} cores", allowed_.size(),
                    threads));
  }
}

CoreLimits NodeAffinity::Limits() const {
  CoreLimits limits = ReadCoreLimits();
  if (!allowed_.empty() && CpusOfMask() == set_)
    limits.affinity = static_cast<int>(allowed_.size());
  return limits;
}

void NodeAffinity::Apply(const std::vector<int>& cpus) {
  // The calling thread is first: threads that it makes inherit its mask.
  if (!SetMask(0, cpus)) {
    log::Warning("cannot keep the learner on one NUMA node: {}", std::strerror(errno));
    return;
  }
  set_ = cpus;
  for (const pid_t thread : ThreadsOfProcess()) {
    if (!others_.contains(thread)) SetMask(thread, cpus);  // fails if the thread has ended
  }
}

void NodeAffinity::Say(const std::string& line) {
  if (line == said_) return;
  said_ = line;
  log::Info("{}", line);
}

}  // namespace shoal::learner

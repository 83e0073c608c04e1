// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/leftovers.h"

#include <fmt/core.h>
#include <unistd.h>

#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/dds/claim_domain.h"
#include "tests/soak/run_under_test.h"
#include "tests/support/processes.h"

namespace shoal::soak {
namespace {

namespace fs = std::filesystem;

void CheckProcesses(const fs::path& run) {
  if (const auto pid = AnyMember(run)) throw Broken(fmt::format("process {} is left", *pid));
  // This process adopts orphans (main.cpp), so all that is left would be a child of ours.
  for (const pid_t pid : ChildrenOf(getpid())) {
    throw Broken(fmt::format("process {} is left{}", pid, HasEnded(pid) ? " as a zombie" : ""));
  }
}

void CheckFiles(const fs::path& run) {
  for (const auto& entry : fs::recursive_directory_iterator(run)) {
    const std::string name = entry.path().filename();
    if (name.find(".tmp") != std::string::npos || name.ends_with(".new") ||
        name.ends_with(".old")) {
      throw Broken(entry.path().string() + " is left");
    }
    if ((entry.status().permissions() & fs::perms::others_write) != fs::perms::none) {
      throw Broken(entry.path().string() + " can be written by others");
    }
  }
}

}  // namespace

std::set<std::string> SharedMemoryObjects() {
  std::set<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it("/dev/shm", error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename();
    // A fuzzer or a simulation that runs meanwhile makes these and changes them all the time.
    if (name.starts_with("shoal-fuzz-") || name.starts_with("shoal-simulate-")) continue;
    names.insert(name);
  }
  return names;
}

void CheckNothingIsLeft(const fs::path& run, const fs::path& temporary_files,
                        const std::set<std::string>& shared_memory_before) {
  CheckProcesses(run);
  CheckFiles(run);
  for (const auto& entry : fs::directory_iterator(temporary_files)) {
    throw Broken(entry.path().string() + " is left");
  }
  for (const std::string& name : SharedMemoryObjects()) {
    if (!shared_memory_before.contains(name)) throw Broken("/dev/shm/" + name + " is left");
  }
  const ClusterAddress address = ReadClusterAddress(run);
  if (!dds::RunPortsFree(address.domain)) {
    throw Broken(fmt::format("UDP ports of DDS domain {} are still taken", address.domain));
  }
}

}  // namespace shoal::soak

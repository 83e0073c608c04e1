// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/run_leftovers.h"

#include <fmt/core.h>

#include <vector>

#include "common/base/clock.h"
#include "common/base/interrupted.h"
#include "common/base/sleep.h"
#include "common/config/run_membership.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kLookAgain{100};

// Temporary names that files.h, checkpoints, `best`, the ring and the account use.
bool IsUnfinished(const std::string& name) {
  const size_t tmp = name.rfind(".tmp");
  if (tmp != std::string::npos && tmp > 0) {
    const std::string rest = name.substr(tmp + 4);
    return rest.empty() || (rest[0] == '-' && rest.size() > 1 &&
                            rest.find_first_not_of("0123456789", 1) == std::string::npos);
  }
  return name == std::string(kRingFile) + ".new" || name == std::string(kAccountingFile) + ".new" ||
         (name.starts_with(".step_") && name.ends_with(".old"));
}

}  // namespace

void WaitForFormerProcesses(const fs::path& run, std::chrono::seconds deadline,
                            const std::function<bool()>& stop,
                            const std::function<void(const std::string&)>& say) {
  const SteadyTime start = Now();
  bool said = false;
  while (const auto pid = AnyMember(run)) {
    if (stop()) throw Interrupted(fmt::format("process {} still works on the run", *pid));
    if (Now() - start > deadline) {
      throw RuntimeError(
          "process {} of an earlier session still works on the run '{}' after {} s: end it first",
          *pid, run.string(), deadline.count());
    }
    if (!said) {
      say(
          fmt::format("processes of an earlier session (such as {}) are still storing records: "
                      "waiting up to {} s",
                      *pid, deadline.count()));
      said = true;
    }
    SleepFor(kLookAgain);
  }
}

int RemoveUnfinishedFiles(const fs::path& run) {
  std::vector<fs::path> unfinished;
  std::error_code error;
  for (fs::recursive_directory_iterator it(run, error), end; !error && it != end;
       it.increment(error)) {
    if (!IsUnfinished(it->path().filename())) continue;
    unfinished.push_back(it->path());
    it.disable_recursion_pending();
  }
  int removed = 0;
  for (const fs::path& path : unfinished) {
    fs::remove_all(path, error);
    if (!error) ++removed;
  }
  return removed;
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_disk.h"

#include <cerrno>

#include "common/base/clock.h"
#include "common/base/scheduler.h"
#include "common/base/sleep.h"

namespace shoal::simulation {
namespace {

// One step in kSlow takes up to kSlowest.
constexpr uint64_t kSlow = 16;
constexpr int64_t kSlowest = 30'000;  // us

constexpr uint64_t kFailing = 3;  // one step in kFailing fails

}  // namespace

int SimulatedDisk::Before(const std::string&) {
  if (Scheduler::Current() == nullptr) return 0;
  if (random_.Below(kSlow) == 0) {
    SleepFor(std::chrono::microseconds(random_.Below(kSlowest)));
  }
  const SteadyTime now = Now();
  int error = 0;
  if (now < full_until_) error = ENOSPC;
  if (now < failing_until_ && ThreadGroup::Current() == failing_ && random_.Below(kFailing) == 0) {
    error = EIO;
  }
  if (error != 0) ++failures_;
  return error;
}

}  // namespace shoal::simulation

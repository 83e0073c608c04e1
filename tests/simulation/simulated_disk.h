// SPDX-License-Identifier: Apache-2.0
// A disk with faults (common/base/disk_steps.h). For some time, the disk is full for all processes,
// or steps of one process fail. Some steps are slow, so that other threads run in between and a
// kill can leave a file half written.
#pragma once

#include <cstdint>
#include <string>

#include "common/base/disk_steps.h"
#include "common/base/random.h"
#include "common/base/steady_time.h"
#include "common/base/thread_group.h"

namespace shoal::simulation {

// The faults affect simulated threads only.
class SimulatedDisk final : public DiskSteps {
 public:
  explicit SimulatedDisk(uint64_t seed) : random_(seed) { DiskSteps::SetCurrent(this); }
  ~SimulatedDisk() override { DiskSteps::SetCurrent(nullptr); }
  SimulatedDisk(const SimulatedDisk&) = delete;
  SimulatedDisk& operator=(const SimulatedDisk&) = delete;

  void BeFull(SteadyTime until) { full_until_ = until; }
  void Fail(const ThreadGroup* process, SteadyTime until) {
    failing_ = process;
    failing_until_ = until;
  }

  int Before(const std::string& path) override;

  uint64_t failures() const { return failures_; }

 private:
  Random random_;
  SteadyTime full_until_{}, failing_until_{};
  const ThreadGroup* failing_ = nullptr;
  uint64_t failures_ = 0;
};

}  // namespace shoal::simulation

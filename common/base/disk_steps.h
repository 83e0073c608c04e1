// SPDX-License-Identifier: Apache-2.0
// Interface for simulated disks. The code that writes the files of a run calls DiskStep before each
// step that changes the disk: creating a file, writing half of it, fsync, rename. In the product,
// DiskStep always returns 0; a call costs one read of memory.
#pragma once

#include <string>

namespace shoal {

class DiskSteps {
 public:
  virtual ~DiskSteps() = default;

  // Returns 0 if the step on `path` succeeds, or the errno with which the step fails. May let other
  // simulated threads run, so that a process can be killed between two steps.
  virtual int Before(const std::string& path) = 0;

  // The program's instance; nullptr outside simulations.
  static DiskSteps* Current() { return current_; }
  static void SetCurrent(DiskSteps* steps) { current_ = steps; }

 private:
  static inline constinit DiskSteps* current_ = nullptr;
};

// Call this function before a step on `path`. Returns 0 if the step succeeds, or the errno with
// which the step fails.
inline int DiskStep(const std::string& path) {
  DiskSteps* const steps = DiskSteps::Current();
  return steps == nullptr ? 0 : steps->Before(path);
}

}  // namespace shoal

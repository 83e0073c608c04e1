// SPDX-License-Identifier: Apache-2.0
// The memory that a physics half writes its observation to. The goal half gives the sizes, the
// physics half writes the numbers. If the two disagree, the write would corrupt the heap or leave a
// number unwritten.
//
//   guard | state vector | guard | achieved goal | guard | desired goal | guard
//
// Before each Read every number and every guard value is set to one bit pattern, a NaN that
// arithmetic does not produce. Afterwards the guards must still have it, and no number may. Cost:
// 0.13 to 0.16 us per control step; a step of the built-in tasks takes some hundred us without
// pictures.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "actor/worlds/world.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

class ObservedNumbers {
 public:
  // Values behind each part. A write beyond them is not detected.
  static constexpr size_t kGuard = 64;

  // Borrows the task.
  explicit ObservedNumbers(const tasks::Task& task);

  // Calls world.Observe. Throws Error (kUsage), in one line that names the task, the block, its
  // size in the goal half and how many numbers were written, when the sizes disagree.
  void Read(const World& world);

  // Numbers of the last Read; valid until the next.
  std::span<const double> state() const { return Numbers(state_); }
  std::span<const double> achieved_goal() const { return Numbers(achieved_); }
  std::span<const double> desired_goal() const { return Numbers(desired_); }

 private:
  struct Part {
    size_t first = 0, size = 0;
  };

  std::span<const double> Numbers(const Part& part) const {
    return std::span(memory_).subspan(part.first, part.size);
  }
  std::span<double> Writable(const Part& part) {
    return std::span(memory_).subspan(part.first, part.size);
  }
  void CheckWritten(const Part& part, const std::vector<tasks::Block>& blocks) const;
  [[noreturn]] void ThrowBeyond(const Part& part, const std::vector<tasks::Block>& blocks) const;
  [[noreturn]] void ThrowUnwritten(const Part& part, const std::vector<tasks::Block>& blocks,
                                   size_t first) const;

  const tasks::Task& task_;
  const std::vector<tasks::Block> achieved_block_, desired_block_;
  Part state_, achieved_, desired_;
  std::vector<double> memory_;
};

}  // namespace shoal::worlds

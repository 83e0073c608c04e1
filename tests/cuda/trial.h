// SPDX-License-Identifier: Apache-2.0
// Trials of a device: each makes a row of a table.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "learner/device/device.h"

namespace shoal::trial {

struct Row {
  std::string trial;              // "product f32 (128, 50) x (50, 256)"
  double figure = 0;              // an error or a rate
  std::string unit;               // "relative error" | "updates/s"
  std::optional<double> limit{};  // an error must be at most this number, a rate at least
  bool passed = true;
  std::string fault{};  // the error that ended the trial; empty if there was none
};

class Trials {
 public:
  using Show = std::function<void(const Row&)>;

  // Makes only the trials whose name contains `only`.
  Trials(std::string only, Show show);

  // An error of at most `limit`.
  void TryError(const std::string& name, const std::string& unit, double limit,
                const std::function<double()>& error) const;
  // A rate of at least `limit`; null: any rate.
  void TryRate(const std::string& name, const std::string& unit, std::optional<double> limit,
               const std::function<double()>& rate) const;

 private:
  // A trial that throws Error has not passed; the next trial follows.
  void Try(Row row, const std::function<double()>& figure, bool at_most) const;

  const std::string only_;
  const Show show_;
};

// Runs products and convolutions of the networks' shapes on the device and on the host's device,
// with equal inputs and poisoned results. A row for each: the largest difference, divided by the
// largest number of the host's result. `quick`: small shapes only.
void TryCommands(learner::device::Device* device, bool quick, const Trials& trials);

struct UpdateTrials {
  learner::device::Device* device = nullptr;  // null: the CPU is compared with itself
  bool quick = false;                         // fewer updates of fewer networks
  int stretch = 0;                            // updates in a row; 0: those of the limits
};

// Compares updates of each algorithm and encoder on the device with those of the CPU
// (agent_comparison.h): 200 updates, of PPO 10 rollouts. Three rows for each: figures of the first
// update, and the median and the largest difference of the changes of parameters.
void TryUpdates(const UpdateTrials& what, const Trials& trials);

// Rates of SAC's update on the device, with batches in host memory, and of the copies of batches.
// `seconds` for each row.
void TimeUpdates(learner::device::Device* device, bool quick, double seconds, const Trials& trials);

}  // namespace shoal::trial

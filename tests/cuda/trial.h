// SPDX-License-Identifier: Apache-2.0
// Trials of a device: rows of a table, and the trials that make them.
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
};

using Show = std::function<void(const Row&)>;

// Runs products and convolutions of the networks' shapes on the device and on the host's device,
// with equal inputs and poisoned results. A row for each: the largest difference, divided by the
// largest number of the host's result. `quick`: small shapes only.
void TryCommands(learner::device::Device* device, bool quick, const Show& show);

// Makes 200 updates of each algorithm and encoder (of PPO: 40 minibatches from vectors, 4 from
// pixels) on the device and on the CPU with equal batches and draws, and shows the relative
// difference of the parameters. `quick`: few updates, small networks.
void TryUpdates(learner::device::Device* device, bool quick, const Show& show);

// Rates of SAC's update on the device, with batches in host memory. `seconds` for each row.
void TimeUpdates(learner::device::Device* device, bool quick, double seconds, const Show& show);

}  // namespace shoal::trial

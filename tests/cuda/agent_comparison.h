// SPDX-License-Identifier: Apache-2.0
// Updates of an agent on a device beside those of an agent on the CPU.
//
// Rounding errors grow from update to update: if rounding switches a ReLU or the sign of a small
// gradient, the next updates differ, and Adam's steps do not depend on the size of a gradient.
// After 200 updates, two agents on the CPU that add in different orders differ as much as a GPU and
// a CPU (docs/notes/rounding-of-updates.md). A comparison therefore consists of short stretches.
// Before each stretch the device gets the state of the CPU's agent, which makes all updates. Errors
// of rounding then stay small, and a fault of the device is found in any part of the updates.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/nn/precision.h"
#include "common/spec/observation_spec.h"
#include "learner/device/device.h"

namespace shoal::trial {

struct Setting {
  std::string algorithm, encoder;  // encoder "" = vectors only
  nn::Precision precision;
};

// Text about the setting: "sac, compact, f32".
std::string Describe(const Setting& setting);
Config ConfigOf(const Setting& setting, int batch);
// Observations are frames of 84x84 pixels, or vectors.
ObservationSpec SpecOf(const Setting& setting);

// The CPU's agent makes `updates` updates with a few batches in turn. A stretch of `stretch`
// updates begins at every `every`th update. An update on policy is a rollout: 2 epochs with 2
// minibatches.
struct Schedule {
  int updates, every, stretch;
  int batch;  // rows
};

struct Differences {
  // Largest difference of a figure (a loss or a norm of gradients) of the first update of all,
  // relative to 1 + the CPU's value.
  double figures = 0;
  // For each stretch the network whose change differs most. The change of a network is that of all
  // its parameters in the stretch. Its difference is the Euclidean distance of both agents'
  // parameters, relative to the length of the CPU's change. Infinite if a number is not finite.
  std::vector<double> changes;

  double MedianChange() const;
  double LargestChange() const;
};

// device null: compares the CPU with itself. Instead of a device's agent, there is an agent of one
// thread of the CPU, and each stretch begins with parameters that are changed by 1e-7 of their
// values, which is the size of rounding errors. Throws Error.
Differences CompareUpdates(learner::device::Device* device, const Setting& setting,
                           const Schedule& schedule);

}  // namespace shoal::trial

// SPDX-License-Identifier: Apache-2.0
// The processor that computes the updates of a run: the CPU, or a GPU of the learner's host.
//
// learner.device = cuda: the GPU; auto: the GPU if it can be used, else the CPU, with one line that
// says why. If a GPU fails in the middle of a run, the learner ends with the exit code of
// ErrorKind::kDevice and is restarted from its checkpoint. With auto, a learner that has lost its
// GPU kMostLosses times computes on the CPU. The run's file learner_device.json has the choice and
// the number of losses.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "common/base/error.h"
#include "common/config/run_config.h"
#include "common/nn/precision.h"
#include "common/run_folder/learner_device_file.h"
#include "learner/agent/algorithms.h"
#include "learner/device/card_loader.h"
#include "learner/device/device.h"
#include "learner/pin_memory.h"

namespace shoal::learner {

// Not movable: agents borrow the device.
class LearnerDevice {
 public:
  // GPUs that a run with learner.device = auto loses before it continues on the CPU.
  static constexpr uint64_t kMostLosses = 2;

  // Chooses the processor of the run in `folder`, opens the GPU and logs the choice. Throws Error
  // (kUsage) if the run asks for a GPU that cannot be used, or Error (kDevice) if it lost one
  // before.
  LearnerDevice(std::filesystem::path folder, const RunConfig& run);
  LearnerDevice(const LearnerDevice&) = delete;
  LearnerDevice& operator=(const LearnerDevice&) = delete;

  bool on_gpu() const { return device_ != nullptr; }
  nn::Precision precision() const { return precision_; }
  // One line: "NVIDIA H100 80GB HBM3 (85 GB, driver 580.159.04)". Not on the CPU.
  std::string Description() const { return Describe(record_); }
  // Makes the run's agent on the GPU. Not on the CPU.
  std::unique_ptr<Agent> MakeAgent(const RunConfig& run);
  // Pins memory for the GPU; empty on the CPU. Borrows this object.
  PinMemory Pin();
  // The use of the GPU; nullopt on the CPU, or if it is unknown.
  std::optional<CardUse> Look() const;
  // Runs `work`. If it throws an Error of the kind kDevice, counts the loss in the run's file.
  template <class Work>
  auto CountingLosses(const Work& work) {
    try {
      return work();
    } catch (const Error& error) {
      if (error.exit_code() == static_cast<int>(ErrorKind::kDevice)) NoteLoss();
      throw;
    }
  }

 private:
  void NoteLoss();
  void Choose(const RunConfig& run);
  void Open(const RunConfig& run);

  const std::filesystem::path folder_;
  LearnerDeviceRecord record_;
  nn::Precision precision_;
  std::optional<OpenedCard> card_;
  std::unique_ptr<device::Device> device_;
};

// Whether a learner of this host would compute on a GPU: learner.device is cuda, or it is auto and
// a GPU can be used.
bool UsesGpu(const LearnerConfig& learner);

// Refuses learner.device = cuda before a run starts. Throws Error (kUsage): this host has no usable
// GPU, or the GPU's engine does not compute the configuration.
void CheckLearnerDevice(const RunConfig& run);

}  // namespace shoal::learner

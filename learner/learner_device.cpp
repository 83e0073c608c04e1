// SPDX-License-Identifier: Apache-2.0
#include "learner/learner_device.h"

#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "learner/device/device_agent.h"

namespace shoal::learner {
namespace {

// The record without its processor; a damaged file counts as a run without losses.
LearnerDeviceRecord RecordBefore(const std::filesystem::path& folder) {
  LearnerDeviceRecord record;
  try {
    if (const auto before = ReadLearnerDevice(folder)) record.losses = before->losses;
  } catch (const Error& e) {
    log::Warning("{}", e.what());
  }
  return record;
}

}  // namespace

LearnerDevice::LearnerDevice(std::filesystem::path folder, const RunConfig& run)
    : folder_(std::move(folder)), precision_(nn::Precision::kF32) {
  const LearnerConfig& learner = run.config.learner;
  if (learner.device == "cpu") {
    precision_ = nn::ChoosePrecision(learner.precision, run.spec.HasPixels());
    return;
  }
  record_ = RecordBefore(folder_);
  Choose(run);
  precision_ = on_gpu() ? nn::ChooseGpuPrecision(learner.precision, run.spec.HasPixels())
                        : nn::ChoosePrecision(learner.precision, run.spec.HasPixels());
  record_.precision = nn::ToString(precision_);
  log::Info("learner.device = {}: computes on {}", learner.device, Describe(record_));
  WriteLearnerDevice(folder_, record_);
}

void LearnerDevice::Choose(const RunConfig& run) {
  const bool automatic = run.config.learner.device == "auto";
  if (automatic && record_.losses >= kMostLosses) {
    record_.reason = fmt::format("the GPU was lost {} times in this run", record_.losses);
    return;
  }
  try {
    Open(run);
  } catch (const Error& e) {
    if (automatic) {
      record_.reason = e.what();
    } else if (record_.losses > 0) {  // a GPU that was lost may come back
      throw DeviceError("learner.device = cuda: {}", e.what());
    } else {
      throw UsageError("learner.device = cuda: {}", e.what());
    }
  }
}

void LearnerDevice::Open(const RunConfig& run) {
  device::CheckComputes(run.config);
  card_ = OpenCard();
  device_.reset(card_->reply.device);
  record_.device = "cuda";
  record_.card = card_->info.name;
  record_.driver = card_->info.driver;
  record_.memory_bytes = card_->info.memory_bytes;
}

std::unique_ptr<Agent> LearnerDevice::MakeAgent(const RunConfig& run) {
  CHECK(on_gpu());
  return CountingLosses(
      [&] { return device::MakeDeviceAgent(run.config, run.spec, precision_, device_.get()); });
}

PinMemory LearnerDevice::Pin() { return on_gpu() ? PinOn(device_.get()) : PinMemory{}; }

std::optional<CardUse> LearnerDevice::Look() const { return card_ ? card_->Look() : std::nullopt; }

void LearnerDevice::NoteLoss() {
  ++record_.losses;
  try {
    WriteLearnerDevice(folder_, record_);
  } catch (const Error& e) {  // the error of the GPU is the one that the run must see
    log::Warning("{}", e.what());
  }
}

bool UsesGpu(const LearnerConfig& learner) {
  if (learner.device != "auto") return learner.device == "cuda";
  try {
    ProbeCard();
    return true;
  } catch (const Error&) {
    return false;
  }
}

void CheckLearnerDevice(const RunConfig& run) {
  if (run.config.learner.device != "cuda") return;
  try {
    device::CheckComputes(run.config);
    ProbeCard();
  } catch (const Error& e) {
    throw UsageError("learner.device = cuda: {}", e.what());
  }
}

}  // namespace shoal::learner

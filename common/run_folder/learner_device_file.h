// SPDX-License-Identifier: Apache-2.0
// learner_device.json of a run (schema shoal-learner-device-1): the processor that computes the
// updates, and how often a GPU was lost. The learner writes the file when it starts and when it
// loses its GPU; a restarted learner continues the count. The coordinator copies the processor to
// meta.json.
//
//   {schema, device ("cpu" | "cuda"), card, driver, memory_bytes, precision, reason, losses}
//
// card, driver: null on the CPU. reason: why learner.device = auto chose the CPU, else null.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace shoal {

struct LearnerDeviceRecord {
  std::string device = "cpu";
  std::string card{};         // name of the GPU: "NVIDIA H100 80GB HBM3"; empty on the CPU
  std::string driver{};       // version of its driver: "580.159.04"
  uint64_t memory_bytes = 0;  // of the GPU
  std::string precision{};    // "f32" | "bf16"
  std::string reason{};
  uint64_t losses = 0;  // GPUs lost since the run was started or resumed

  bool operator==(const LearnerDeviceRecord&) const = default;
};

// One line about the processor: "NVIDIA H100 80GB HBM3 (85 GB, driver 580.159.04)", or "the CPU:
// REASON".
std::string Describe(const LearnerDeviceRecord& record);

// Reads the file of a run; nullopt if there is none. Throws Error naming the file and the member if
// a member is missing or has another type.
std::optional<LearnerDeviceRecord> ReadLearnerDevice(const std::filesystem::path& run);
// Replaces the file atomically. Throws Error.
void WriteLearnerDevice(const std::filesystem::path& run, const LearnerDeviceRecord& record);

}  // namespace shoal

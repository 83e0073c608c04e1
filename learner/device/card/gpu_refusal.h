// SPDX-License-Identifier: Apache-2.0
// Says in one line why no GPU can be used. Uses no CUDA, so tests need none.
#pragma once

#include <cstdint>
#include <string>

namespace shoal::learner::device {

// Answers of CUDA and of the environment about the GPUs of this host.
struct GpuFindings {
  std::string error;    // of the request for the number of GPUs; empty if it succeeded
  int runtime_version;  // of CUDA in this library: 13000 = 13.0
  int driver_version;   // newest CUDA that the driver supports; 0 without a driver
  int gpus;             // that this process may use
  const char* visible;  // CUDA_VISIBLE_DEVICES; null if it is not set
  const char*
      slurm_gpus;  // SLURM_JOB_GPUS or SLURM_STEP_GPUS; null outside of Slurm's jobs with GPUs
  bool in_slurm;   // in a job of Slurm
};

// Empty if a GPU is visible.
std::string WhyNoGpu(const GpuFindings& findings);

// Properties of the first visible GPU that decide whether it is used.
struct GpuProperties {
  std::string name;
  int major, minor;  // compute capability
  int64_t free_bytes, memory_bytes;
};

inline constexpr int kLeastMajor = 8;  // bf16 products
inline constexpr int64_t kLeastFreeBytes = int64_t{512}
                                           << 20;  // libraries and the smallest networks

// Empty if the GPU can be used. `free_bytes` < 0: not known.
std::string WhyNotThisGpu(const GpuProperties& gpu);

}  // namespace shoal::learner::device

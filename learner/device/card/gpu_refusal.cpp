// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/gpu_refusal.h"

#include <fmt/core.h>

namespace shoal::learner::device {
namespace {

std::string Version(int cuda) { return fmt::format("{}.{}", cuda / 1000, cuda % 1000 / 10); }

}  // namespace

std::string WhyNoGpu(const GpuFindings& f) {
  if (f.error.empty() && f.gpus > 0) return "";
  if (f.driver_version == 0) return "this host has no NVIDIA driver (no libcuda.so.1)";
  if (f.driver_version / 1000 < f.runtime_version / 1000) {
    return fmt::format("the NVIDIA driver is too old: it supports CUDA {}, expected at least {}.0",
                       Version(f.driver_version), f.runtime_version / 1000);
  }
  if (f.visible != nullptr) {
    return fmt::format("CUDA_VISIBLE_DEVICES = '{}' hides every GPU from this process", f.visible);
  }
  if (f.in_slurm && f.slurm_gpus == nullptr) {
    return "this job of Slurm was given no GPU: expected sbatch or srun with --gres=gpu:1";
  }
  return fmt::format("this host has no NVIDIA GPU{}",
                     f.error.empty() ? "" : fmt::format(" that answers: {}", f.error));
}

std::string WhyNotThisGpu(const GpuProperties& gpu) {
  if (gpu.major < kLeastMajor) {
    return fmt::format("the GPU {} has compute capability {}.{}: expected at least {}.0 (bf16)",
                       gpu.name, gpu.major, gpu.minor, kLeastMajor);
  }
  if (gpu.free_bytes >= 0 && gpu.free_bytes < kLeastFreeBytes) {
    return fmt::format(
        "the GPU {} has {} of {} MB of memory free: expected at least {}; nvidia-smi lists the "
        "processes that use it",
        gpu.name, gpu.free_bytes >> 20, gpu.memory_bytes >> 20, kLeastFreeBytes >> 20);
  }
  return "";
}

}  // namespace shoal::learner::device

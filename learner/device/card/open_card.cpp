// SPDX-License-Identifier: Apache-2.0
// The exported function of libshoal-cuda.so (card_library.h).
#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <string>

#include "learner/device/card/cuda_device.h"
#include "learner/device/card/cuda_error.h"
#include "learner/device/card/gpu_refusal.h"
#include "learner/device/card/nvml.h"
#include "learner/device/card_library.h"

namespace shoal::learner::device {
namespace {

// Address of the opened GPU on the PCI bus, for NVML. Written before the device exists.
char pci_bus_id[32];

template <size_t N>
void Put(const std::string& text, char (&to)[N]) {
  to[text.copy(to, N - 1)] = '\0';
}

int Look(CardUse* use) {
  const auto now = NvmlUse(pci_bus_id);
  if (now) *use = *now;
  return now ? 1 : 0;
}

GpuFindings FindGpus() {
  GpuFindings findings{};
  const cudaError_t status = cudaGetDeviceCount(&findings.gpus);
  if (status != cudaSuccess) findings.error = cudaGetErrorString(status);
  cudaGetLastError();
  cudaRuntimeGetVersion(&findings.runtime_version);
  cudaDriverGetVersion(&findings.driver_version);
  findings.visible = std::getenv("CUDA_VISIBLE_DEVICES");
  findings.slurm_gpus = std::getenv("SLURM_JOB_GPUS");
  if (findings.slurm_gpus == nullptr) findings.slurm_gpus = std::getenv("SLURM_STEP_GPUS");
  findings.in_slurm = std::getenv("SLURM_JOB_ID") != nullptr;
  return findings;
}

// CUDA's version of the driver stands in for the driver's own version if NVML is missing.
std::string DriverVersion(int cuda) {
  const std::string version = NvmlDriverVersion();
  if (!version.empty()) return version;
  return "for CUDA " + std::to_string(cuda / 1000) + "." + std::to_string(cuda % 1000 / 10);
}

// Returns the reason of a refusal.
std::string Open(bool open, ShoalCardReply* reply) {
  const GpuFindings findings = FindGpus();
  std::string refusal = WhyNoGpu(findings);
  if (!refusal.empty()) return refusal;
  cudaDeviceProp properties{};
  Require(cudaGetDeviceProperties(&properties, 0), "reading the GPU's properties");
  Put(properties.name, reply->name);
  Put(DriverVersion(findings.driver_version), reply->driver);
  reply->memory_bytes = properties.totalGlobalMem;
  GpuProperties gpu{.name = properties.name,
                    .major = properties.major,
                    .minor = properties.minor,
                    .free_bytes = -1,
                    .memory_bytes = static_cast<int64_t>(properties.totalGlobalMem)};
  refusal = WhyNotThisGpu(gpu);
  if (!refusal.empty() || !open) return refusal;
  size_t free = 0, total = 0;
  Require(cudaMemGetInfo(&free, &total), "opening the GPU");
  gpu.free_bytes = static_cast<int64_t>(free);
  refusal = WhyNotThisGpu(gpu);
  if (!refusal.empty()) return refusal;
  Require(cudaDeviceGetPCIBusId(pci_bus_id, sizeof(pci_bus_id), 0), "opening the GPU");
  reply->look = Look;
  reply->device = new CudaDevice({.name = reply->name,
                                  .driver = reply->driver,
                                  .memory_bytes = gpu.memory_bytes,
                                  .f32_channels = 1,
                                  .bf16_channels = 8});
  return "";
}

}  // namespace
}  // namespace shoal::learner::device

extern "C" __attribute__((visibility("default"))) void ShoalOpenCard(
    const shoal::learner::ShoalCardRequest* request, shoal::learner::ShoalCardReply* reply) {
  using namespace shoal::learner::device;  // NOLINT: a C function has no namespace
  const std::string version = shoal::learner::CardLibraryVersion();
  Put(version, reply->version);
  if (version != request->version) return;  // the caller names both versions
  try {
    Put(Open(request->open != 0, reply), reply->refusal);
  } catch (const std::exception& error) {
    Put(error.what(), reply->refusal);
  }
}

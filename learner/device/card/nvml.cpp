// SPDX-License-Identifier: Apache-2.0
#include "learner/device/card/nvml.h"

#include <dlfcn.h>

namespace shoal::learner::device {
namespace {

// Declarations of NVML's stable interface, which toolkits without a driver lack.
using NvmlDevice = struct NvmlDeviceTag*;
struct NvmlUtilization {
  unsigned int gpu;     // percent of the last sample period in which a kernel ran
  unsigned int memory;  // percent in which memory was read or written
};
struct NvmlMemory {
  unsigned long long total, free, used;  // bytes
};
constexpr int kSuccess = 0;

// The functions of the library; null if it is missing or cannot be initialised.
class Library {
 public:
  Library() {
    void* const library = dlopen("libnvidia-ml.so.1", RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) return;
    const auto init = Find<int()>(library, "nvmlInit_v2");
    driver = Find<int(char*, unsigned int)>(library, "nvmlSystemGetDriverVersion");
    find = Find<int(const char*, NvmlDevice*)>(library, "nvmlDeviceGetHandleByPciBusId_v2");
    utilization = Find<int(NvmlDevice, NvmlUtilization*)>(library, "nvmlDeviceGetUtilizationRates");
    memory = Find<int(NvmlDevice, NvmlMemory*)>(library, "nvmlDeviceGetMemoryInfo");
    usable = init != nullptr && driver != nullptr && find != nullptr && utilization != nullptr &&
             memory != nullptr && init() == kSuccess;
  }

  bool usable = false;
  int (*driver)(char* version, unsigned int length) = nullptr;
  int (*find)(const char* pci_bus_id, NvmlDevice* device) = nullptr;
  int (*utilization)(NvmlDevice device, NvmlUtilization* utilization) = nullptr;
  int (*memory)(NvmlDevice device, NvmlMemory* memory) = nullptr;

 private:
  template <class Function>
  static Function* Find(void* library, const char* name) {
    return reinterpret_cast<Function*>(dlsym(library, name));
  }
};

// NVML may be used by all threads and is never closed.
const Library& Nvml() {
  static const Library* const library = new Library;
  return *library;
}

}  // namespace

std::string NvmlDriverVersion() {
  char version[80] = {};
  const Library& nvml = Nvml();
  if (!nvml.usable || nvml.driver(version, sizeof(version)) != kSuccess) return "";
  return version;
}

std::optional<CardUse> NvmlUse(const char* pci_bus_id) {
  const Library& nvml = Nvml();
  NvmlDevice device = nullptr;
  NvmlMemory memory{};
  if (!nvml.usable || nvml.find(pci_bus_id, &device) != kSuccess ||
      nvml.memory(device, &memory) != kSuccess) {
    return std::nullopt;
  }
  CardUse use{.memory_bytes = memory.used, .memory_size_bytes = memory.total};
  NvmlUtilization utilization{};
  if (nvml.utilization(device, &utilization) == kSuccess) {  // parts of a GPU (MIG) do not know it
    use.busy = utilization.gpu / 100.0;
  }
  return use;
}

}  // namespace shoal::learner::device

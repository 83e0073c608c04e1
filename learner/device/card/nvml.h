// SPDX-License-Identifier: Apache-2.0
// NVML, NVIDIA's library that observes GPUs. It belongs to the driver and is opened with dlopen;
// without it, the driver's version and the use of the GPU are unknown.
#pragma once

#include <optional>
#include <string>

#include "learner/device/card_library.h"

namespace shoal::learner::device {

// Version of the driver: "580.159.04"; empty without NVML.
std::string NvmlDriverVersion();

// Use of the GPU with this address on the PCI bus ("00000000:65:00.0"); nullopt without NVML. Any
// thread.
std::optional<CardUse> NvmlUse(const char* pci_bus_id);

}  // namespace shoal::learner::device

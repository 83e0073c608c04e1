// Counters among tensors: one U64 each, shape {1}.
#pragma once

#include <cstdint>
#include <string>

#include "common/nn/safetensors.h"

namespace shoal::nn {

void ExportCounter(const std::string& name, uint64_t value, TensorMap* tensors);
// Throws Error naming a missing or ill-typed tensor.
uint64_t ImportCounter(const TensorMap& tensors, const std::string& name,
                       const std::string& source);

}  // namespace shoal::nn

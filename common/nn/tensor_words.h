// SPDX-License-Identifier: Apache-2.0
// Tensors of integers or of the bits of doubles: U64 of shape {n}; a counter has n = 1.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"

namespace shoal::nn {

NamedTensor WordsTensor(const std::vector<uint64_t>& words);
// `count`: the required number of words; empty for any number. Throws Error that names a missing or
// ill-shaped tensor.
std::vector<uint64_t> ReadWords(const TensorMap& tensors, const std::string& name,
                                std::optional<size_t> count, const std::string& source);

void ExportCounter(const std::string& name, uint64_t value, TensorMap* tensors);
uint64_t ImportCounter(const TensorMap& tensors, const std::string& name,
                       const std::string& source);

}  // namespace shoal::nn

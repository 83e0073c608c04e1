// SPDX-License-Identifier: Apache-2.0
// Whole numbers, or the bits of doubles, among tensors: U64 of shape {n}; a counter is one of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"

namespace shoal::nn {

NamedTensor WordsTensor(const std::vector<uint64_t>& words);
// `count`: how many there must be. Throws Error naming a missing or ill-shaped tensor.
std::vector<uint64_t> ReadWords(const TensorMap& tensors, const std::string& name,
                                std::optional<size_t> count, const std::string& source);

void ExportCounter(const std::string& name, uint64_t value, TensorMap* tensors);
uint64_t ImportCounter(const TensorMap& tensors, const std::string& name,
                       const std::string& source);

}  // namespace shoal::nn

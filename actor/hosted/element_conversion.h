// SPDX-License-Identifier: Apache-2.0
// Elements of an environment's arrays as float32.
#pragma once

#include <span>
#include <vector>

#include "common/tasks/environment_spaces.h"

namespace shoal::hosted {

// Converts `array`, which has numbers.size() elements of `type`, to `numbers`.
void ConvertTo(tasks::ElementType type, const void* array, std::span<float> numbers);
std::vector<float> ToFloats(tasks::ElementType type, const void* array, size_t count);

}  // namespace shoal::hosted

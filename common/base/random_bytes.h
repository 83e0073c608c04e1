// SPDX-License-Identifier: Apache-2.0
// Unpredictable bytes from the kernel, for tokens.
#pragma once

#include <cstddef>
#include <span>

namespace shoal {

// Throws Error when the kernel has none. At most 256 bytes.
void FillWithRandomBytes(std::span<std::byte> bytes);

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// Unpredictable bytes from the kernel, for tokens.
#pragma once

#include <cstddef>
#include <span>

namespace shoal {

// Fills at most 256 bytes. Throws Error if the kernel provides no random bytes.
void FillWithRandomBytes(std::span<std::byte> bytes);

}  // namespace shoal

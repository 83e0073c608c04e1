// SPDX-License-Identifier: Apache-2.0
// A recorded trajectory of the original FetchReach, embedded: the first 12 steps of the sequence
// random0 (format vrl-ref-1), so that parity can be checked without reference files.
#pragma once

#include <string_view>

namespace shoal::launch {

std::string_view ParityReference();

}  // namespace shoal::launch

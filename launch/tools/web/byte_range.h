// SPDX-License-Identifier: Apache-2.0
// Part of a file that a request asks for; films need such parts for seeking. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace shoal::launch {

struct ByteRange {
  uint64_t offset = 0, bytes = 0;
};

enum class RangeAsked {
  kWhole,  // no range, several ranges, or an invalid range: the answer is the whole file
  kPart,
  kOutside,  // the range begins after the file's end
};

// `header`: the Range header, "bytes=0-99", "bytes=100-", "bytes=-50". Sets *range if the result is
// kPart.
RangeAsked ParseByteRange(std::string_view header, uint64_t file_bytes, ByteRange* range);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Which part of a file a request is about: what films need for jumping to and fro. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace shoal::launch {

struct ByteRange {
  uint64_t offset = 0, bytes = 0;
};

enum class RangeAsked {
  kWhole,  // no range, several, or none that is understood: the whole file is the answer
  kPart,
  kOutside,  // begins behind the file's end
};

// `header`: the Range header, "bytes=0-99", "bytes=100-", "bytes=-50". Sets *range where kPart.
RangeAsked ParseByteRange(std::string_view header, uint64_t file_bytes, ByteRange* range);

}  // namespace shoal::launch

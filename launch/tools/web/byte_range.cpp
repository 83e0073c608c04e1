// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/byte_range.h"

#include <algorithm>
#include <charconv>

namespace shoal::launch {
namespace {

// Parses digits. Empty if the text is empty, has other characters, or is too large a number.
std::optional<uint64_t> Number(std::string_view text) {
  uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

RangeAsked ParseByteRange(std::string_view header, uint64_t file_bytes, ByteRange* range) {
  constexpr std::string_view kUnit = "bytes=";
  if (!header.starts_with(kUnit)) return RangeAsked::kWhole;
  header.remove_prefix(kUnit.size());
  const size_t dash = header.find('-');
  if (dash == std::string_view::npos) return RangeAsked::kWhole;
  const std::string_view from = header.substr(0, dash), to = header.substr(dash + 1);
  const auto first = Number(from), last = Number(to);
  if ((!from.empty() && !first) || (!to.empty() && !last)) return RangeAsked::kWhole;
  if (!first && !last) return RangeAsked::kWhole;
  if (!first) {  // the last `*last` bytes of the file
    if (*last == 0 || file_bytes == 0) return RangeAsked::kOutside;
    range->bytes = std::min(*last, file_bytes);
    range->offset = file_bytes - range->bytes;
    return RangeAsked::kPart;
  }
  if (last && *last < *first) return RangeAsked::kWhole;
  if (*first >= file_bytes) return RangeAsked::kOutside;
  range->offset = *first;
  range->bytes = std::min(last.value_or(file_bytes - 1), file_bytes - 1) - *first + 1;
  return RangeAsked::kPart;
}

}  // namespace shoal::launch

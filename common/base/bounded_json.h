// SPDX-License-Identifier: Apache-2.0
// Parses JSON from files and messages with a bound on its depth. The JSON library parses any depth,
// but it copies, compares and writes a value by recursion. A text that is nested about 100,000 deep
// therefore overflows the stack. Shoal's own JSON is nested at most ten deep.
//
// All code of the product parses JSON with ParseBoundedJson or with ParseStrictJson
// (common/config), which calls JsonTooDeep first.
#pragma once

#include <string_view>

namespace shoal {

inline constexpr int kMaxJsonDepth = 64;

// Whether arrays and objects of `text` are nested more than kMaxJsonDepth deep. The text need not
// be valid JSON. One pass, no memory.
bool JsonTooDeep(std::string_view text);

// Parses `text`; `Json` is nlohmann::json or ordered_json. Returns a discarded value
// (is_discarded()) if the text is not JSON or is nested too deep.
template <class Json>
Json ParseBoundedJson(std::string_view text) {
  if (JsonTooDeep(text)) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, /*allow_exceptions=*/false);
}

}  // namespace shoal

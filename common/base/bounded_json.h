// SPDX-License-Identifier: Apache-2.0
// Parses JSON from files and messages, with a bound on the nesting depth. The JSON library parses
// any depth, but copies, compares and writes a value by recursion. A text that is nested about
// 100,000 levels deep therefore overflows the stack. Shoal's own JSON has at most ten levels.
//
// All code of the product parses JSON with ParseBoundedJson or with ParseStrictJson
// (common/config), which calls JsonTooDeep first.
#pragma once

#include <string_view>

namespace shoal {

inline constexpr int kMaxJsonDepth = 64;

// Whether arrays and objects of `text` are nested more than kMaxJsonDepth levels deep. The text
// need not be valid JSON. Reads the text once and allocates no memory.
bool JsonTooDeep(std::string_view text);

// Parses `text`; `Json` is nlohmann::json or ordered_json. Returns a discarded value
// (is_discarded()) if the text is not JSON or has more than kMaxJsonDepth levels.
template <class Json>
Json ParseBoundedJson(std::string_view text) {
  if (JsonTooDeep(text)) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, /*allow_exceptions=*/false);
}

}  // namespace shoal

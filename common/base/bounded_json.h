// SPDX-License-Identifier: Apache-2.0
// JSON that came from outside: files and messages. The library parses any depth, but copies,
// compares and writes a value by recursion, so that a text nested some 100,000 deep ends a program
// by its stack. Nothing of ours is nested more than ten deep.
//
// Every parse of the product goes through here, or through ParseStrictJson (common/config), which
// asks JsonTooDeep first.
#pragma once

#include <string_view>

namespace shoal {

inline constexpr int kMaxJsonDepth = 64;

// Whether arrays and objects of `text` are nested more than kMaxJsonDepth deep. The text need not
// be valid JSON. One pass, no memory.
bool JsonTooDeep(std::string_view text);

// `Json` is nlohmann::json or ordered_json. A discarded value (is_discarded()) where the text is
// not JSON or too deep.
template <class Json>
Json ParseBoundedJson(std::string_view text) {
  if (JsonTooDeep(text)) return Json(Json::value_t::discarded);
  return Json::parse(text, nullptr, /*allow_exceptions=*/false);
}

}  // namespace shoal

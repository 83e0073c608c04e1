// SPDX-License-Identifier: Apache-2.0
// Turns text from outside into a part of one line.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

// Replaces line breaks and tabs by blanks. Replaces other control characters by '?', because a
// terminal would execute them.
inline std::string OneLine(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    if ((c >= 0 && c < 0x20) || c == 0x7f) c = '?';
  }
  return line;
}

// Returns the first `most` bytes, without a partial UTF-8 character, and "... (N more bytes)".
// Returns shorter texts unchanged.
inline std::string Shortened(std::string_view text, size_t most) {
  if (text.size() <= most) return std::string(text);
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xc0) == 0x80) --most;
  return std::string(text.substr(0, most)) + "... (" + std::to_string(text.size() - most) +
         " more bytes)";
}

}  // namespace shoal

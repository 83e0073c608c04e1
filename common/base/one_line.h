// Text from outside as a part of one line.
#pragma once

#include <string>
#include <string_view>

namespace shoal {

// Line breaks and tabs become blanks, other control characters (a terminal would obey them) '?'.
inline std::string OneLine(std::string_view text) {
  std::string line(text);
  for (char& c : line) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
    if ((c >= 0 && c < 0x20) || c == 0x7f) c = '?';
  }
  return line;
}

}  // namespace shoal

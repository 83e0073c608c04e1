// SPDX-License-Identifier: Apache-2.0
#include "tests/layering/token_groups.h"

namespace shoal {

bool IsOpeningBracket(std::string_view text) { return text == "(" || text == "[" || text == "{"; }
bool IsClosingBracket(std::string_view text) { return text == ")" || text == "]" || text == "}"; }

size_t BehindGroup(const std::vector<SourceToken>& tokens, size_t begin) {
  int depth = 0;
  for (size_t i = begin; i < tokens.size(); ++i) {
    if (IsOpeningBracket(tokens[i].text)) ++depth;
    if (IsClosingBracket(tokens[i].text) && --depth == 0) return i + 1;
  }
  return tokens.size();
}

size_t BehindAngles(const std::vector<SourceToken>& tokens, size_t begin) {
  int depth = 0;
  for (size_t i = begin; i < tokens.size(); ++i) {
    if (IsOpeningBracket(tokens[i].text)) {
      i = BehindGroup(tokens, i) - 1;
    } else if (tokens[i].text == "<") {
      ++depth;
    } else if (tokens[i].text == ">" && --depth == 0) {
      return i + 1;
    }
  }
  return tokens.size();
}

}  // namespace shoal

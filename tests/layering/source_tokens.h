// SPDX-License-Identifier: Apache-2.0
// A source file as tokens, without comments and preprocessor lines; its macros and includes apart.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace shoal {

struct SourceToken {
  std::string text;  // an identifier, a number, a whole literal with its quotes, or an operator
  int line = 0;

  bool IsIdentifier() const;
};

struct SourceMacro {
  std::string name, text;
  int line = 0;
};

struct SourceText {
  std::vector<SourceToken> tokens;    // `>>` is two tokens, as it may close two template lists
  std::vector<SourceMacro> macros;    // those that are still defined at the end of the file
  std::vector<std::string> includes;  // with quotes: "common/base/error.h"
};

SourceText ReadSource(std::string_view source);

// Identifiers that begin with a small letter, but for kName, and are no members: neither behind
// `.`, `->` or `::` nor with an underscore at the end. The line is that of their first use.
std::map<std::string, int> FreeNames(const SourceText& text);

}  // namespace shoal

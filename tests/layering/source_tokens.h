// SPDX-License-Identifier: Apache-2.0
// A source file as tokens without comments and preprocessor lines, and its macros and includes.
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
  std::vector<SourceMacro> macros;    // macros that are defined at the end of the file
  std::vector<std::string> includes;  // with quotes: "common/base/error.h"
};

SourceText ReadSource(std::string_view source);

// Identifiers in lower case except kName, with the line of their first use. Members are skipped:
// names after `.`, `->` or `::`, and names with a trailing underscore.
std::map<std::string, int> FreeNames(const SourceText& text);

}  // namespace shoal

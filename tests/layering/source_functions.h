// SPDX-License-Identifier: Apache-2.0
// The functions that one source file defines, including members; found without a compiler.
//
// Supports the C++ that this tree uses. A lambda belongs to the enclosing function; a lambda at
// namespace scope is a variable's value and is skipped.
#pragma once

#include <string>
#include <vector>

#include "tests/layering/source_tokens.h"

namespace shoal {

struct SourceFunction {
  std::string name;  // "Ring::Append"; for a test "TEST(Suite, Name)"
  int line = 0;      // line of the body's opening brace
  // Lines of the body, with both braces. A table (a braced list without statements) and a raw
  // string count as one line.
  int lines = 0;
};

std::vector<SourceFunction> FunctionsOf(const SourceText& text);

}  // namespace shoal

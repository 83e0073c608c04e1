// SPDX-License-Identifier: Apache-2.0
// The names that one source file declares at namespace scope; found without a compiler.
//
// Supports the C++ that this tree uses: namespaces, types, functions, variables with one or more
// declarators, aliases, using-declarations, unscoped enumerators, macros, the tests and matchers
// that GoogleTest's macros define, and local constants (kName). Other local names, members and
// specialisations are left out.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace shoal {

enum class NameKind { kFunction, kType, kValue, kAlias, kImport, kMacro, kLocal };

// A part of a scope: "shoal::(unnamed)".
inline constexpr char kUnnamedScope[] = "(unnamed)";

struct SourceName {
  std::string scope;  // "shoal::(unnamed)"; empty for macros and the global namespace
  std::string name;
  NameKind kind = NameKind::kValue;
  bool is_internal = false;  // in an unnamed namespace, or declared with internal linkage
  bool is_definition = true;
  int line = 0;
  std::string text;  // definition of an alias, an import or a macro
};

std::vector<SourceName> NamesOf(std::string_view source);

}  // namespace shoal

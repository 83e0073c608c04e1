// SPDX-License-Identifier: Apache-2.0
// How many faults of language each file may still have (tests/docs/language_allowance.txt). The
// numbers only become smaller: a file above its allowance has a new fault, and a file below it gets
// a lower one by `shoal-language --lower`. Files without a line, new ones among them, may have
// none.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tests/docs/language.h"

namespace shoal {

using FaultsByFile = std::map<std::string, std::vector<LanguageFault>>;
// File -> rule -> number of faults.
using LanguageAllowance = std::map<std::string, std::map<std::string, int>>;

// Lines "FILE RULE COUNT [RULE COUNT]..."; lines that begin with # are comments. Throws Error.
LanguageAllowance ReadAllowance(std::string_view text);
std::string AllowanceText(const LanguageAllowance& allowance);

LanguageAllowance CountFaults(const FaultsByFile& faults);

// The smaller number of both, for each file and rule.
LanguageAllowance Lowered(const LanguageAllowance& allowance, const LanguageAllowance& counts);

// One text per file and rule that is not at its allowance. Faults beyond it are named with their
// lines, the youngest lines first where git knows their age; `root` is the tree's.
std::vector<std::string> Differences(const LanguageAllowance& allowance, const FaultsByFile& faults,
                                     const std::filesystem::path& root);

}  // namespace shoal

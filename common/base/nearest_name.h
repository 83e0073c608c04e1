// SPDX-License-Identifier: Apache-2.0
// Spelling help for names that are typed.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shoal {

// Edits (insert, delete, replace one character) that turn `a` into `b`.
int EditDistance(std::string_view a, std::string_view b);

// Empty where more than half of `word` would have to change: that is another word, not a misspelt
// one.
std::string NearestName(std::string_view word, std::span<const std::string> names);

// "; nearest is 'NAME'" for the end of a refusal; empty without one.
std::string NearestHint(std::string_view word, std::span<const std::string> names);

}  // namespace shoal

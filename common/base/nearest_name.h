// SPDX-License-Identifier: Apache-2.0
// Suggestions for misspelt names.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shoal {

// Smallest number of edits that turn `a` into `b`. One edit inserts, deletes or replaces one
// character.
int EditDistance(std::string_view a, std::string_view b);

// The name nearest to `word`. Empty if more than half of `word` would have to change, because then
// `word` is another word rather than a misspelt name.
std::string NearestName(std::string_view word, std::span<const std::string> names);

// "; nearest is 'NAME'" for the end of an error message; empty if NearestName finds no name.
std::string NearestHint(std::string_view word, std::span<const std::string> names);

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// Finds names that collide if several sources of a target are compiled as one
// (docs/decisions/0016). A build with a compiler cache compiles each source alone and does not find
// them. All sources of a target are compared, because groups have different sizes and change with
// every new source.
//
// Two sources of a target collide in a name of one scope if
// - both declare it with internal linkage, overloads included; aliases, using-declarations and
//   macros with equal contents do not collide, nor do overloaded operators;
// - both define a type of that name, with or without an unnamed namespace;
// - one declares it in an unnamed namespace, and the other declares it in the enclosing namespace,
//   itself or in a header that the first does not include;
// - one declares the constant kName and the other a local constant kName (-Wshadow);
// - one declares a variable in lower case, internal, and the other uses the name for anything of
// its
//   own: as a local name it shadows the variable.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace shoal {

// Target -> its sources that may be compiled in groups, from the root of the tree.
using GroupedSources = std::map<std::string, std::vector<std::string>>;

// Reads lines "TARGET SOURCE", which CMake writes (common/cmake/grouped_sources.cmake).
GroupedSources ReadGroupedSources(const std::filesystem::path& file);

// "TARGET: NAME in FILE:LINE and FILE:LINE", one per name and pair of files, each pair once.
std::vector<std::string> FindCollisions(const std::filesystem::path& root,
                                        const GroupedSources& targets);

}  // namespace shoal

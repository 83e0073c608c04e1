// SPDX-License-Identifier: Apache-2.0
// Finds names that collide if several sources of a target are compiled as one
// (docs/decisions/0016). A build with a compiler cache compiles each source alone and does not find
// these collisions. All sources of a target are compared, because the groups differ between builds
// and change with every new source.
//
// Two sources of a target collide in a name of one scope if
// - both sources declare the name with internal linkage, including overloads. Aliases,
//   using-declarations and macros with equal contents do not collide, and neither do overloaded
//   operators;
// - both sources define a type of this name, with or without an unnamed namespace;
// - one source declares the name in an unnamed namespace, and the other source, or a header that
//   only the other source includes, declares the name in the enclosing namespace;
// - one source declares the constant kName, and the other source a local constant kName (-Wshadow);
// - one source declares an internal variable in lower case, and the other source uses the name for
//   another thing, because a local name would shadow the variable.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace shoal {

// The sources that may be compiled in groups, by target, as paths from the root of the tree.
using GroupedSources = std::map<std::string, std::vector<std::string>>;

// Reads lines "TARGET SOURCE", which CMake writes (common/cmake/grouped_sources.cmake).
GroupedSources ReadGroupedSources(const std::filesystem::path& file);

// One line for each name and each pair of files: "TARGET: NAME in FILE:LINE and FILE:LINE".
std::vector<std::string> FindCollisions(const std::filesystem::path& root,
                                        const GroupedSources& targets);

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// Paths of the source tree and of the built programs. Compiled in once (paths.cpp), so that no
// test's own object depends on the tree's place.
#pragma once

#include <string>

namespace shoal {

std::string SourcePath(const std::string& file);   // "docs/monitoring.md" in the source tree
std::string GoldenPath(const std::string& file);   // the same in tests/golden
std::string ProgramPath(const std::string& name);  // "shoal" in the build's bin folder

}  // namespace shoal

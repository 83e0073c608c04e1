// SPDX-License-Identifier: Apache-2.0
// Paths of the source tree and of the built programs. Only paths.cpp contains the paths, so that no
// other object file depends on the location of the tree.
#pragma once

#include <string>

namespace shoal {

std::string SourcePath(const std::string& file);   // "docs/monitoring.md" in the source tree
std::string GoldenPath(const std::string& file);   // path of a file in tests/golden
std::string ProgramPath(const std::string& name);  // "shoal" in the build's bin folder

}  // namespace shoal

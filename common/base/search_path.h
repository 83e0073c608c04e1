// SPDX-License-Identifier: Apache-2.0
// Programs on the search path (PATH).
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace shoal {

// Whether `path` is a file that this process may execute.
bool IsExecutable(const std::filesystem::path& path);

// The first executable file of this name in the folders of PATH; empty if there is no such file.
std::optional<std::filesystem::path> FindOnSearchPath(const std::string& program);

}  // namespace shoal

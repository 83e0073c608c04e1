// SPDX-License-Identifier: Apache-2.0
// Presets and experiments: JSON files, one for each name, with one folder for each kind.
//
// The search uses the first of these folders that has the file:
//   PROJECT/KIND                  the working folder, if it is a user's project (shoal new)
//   PROGRAM/KIND                  folder of the program: a copy of some files without installation
//   PROGRAM/../share/shoal/KIND   an installation or a build folder
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shoal {

// If the working folder contains this file, it is a project.
inline constexpr char kProjectFile[] = "shoal-project.json";

// The folders that the search uses, existing or not. `kind`: "presets" or "experiments".
std::vector<std::filesystem::path> SharedDataFolders(const std::string& kind);
// Names of all presets, or of all experiments, sorted.
std::vector<std::string> ListSharedData(const std::string& kind);
// The file with this name; empty if there is none. A name with '/' is never found, so that the
// search cannot leave the folders.
std::optional<std::filesystem::path> FindSharedData(const std::string& kind,
                                                    const std::string& name);

}  // namespace shoal

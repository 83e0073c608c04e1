// SPDX-License-Identifier: Apache-2.0
// Presets, experiments and references: JSON files, one for each name, with one folder for each
// kind.
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

// The folders that the search uses, existing or not. `kind`: "presets",
// "experiments" or "references".
std::vector<std::filesystem::path> SharedDataFolders(const std::string& kind);
// Names of all files of a kind, sorted.
std::vector<std::string> ListSharedData(const std::string& kind);
// The file with this name; empty if there is none. A name with '/' is never found, so that the
// search cannot leave the folders.
std::optional<std::filesystem::path> FindSharedData(const std::string& kind,
                                                    const std::string& name);

// The path of FILE or NAME, a word of a command line. A word with '/' or with the extension .json
// is a path, which may not exist; any other word is a name. `noun` names the kind in errors. Throws
// Error (kUsage) that lists the existing names.
std::filesystem::path FindFileOrSharedData(const std::string& kind, const std::string& noun,
                                           const std::string& file_or_name);

}  // namespace shoal

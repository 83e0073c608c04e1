// SPDX-License-Identifier: Apache-2.0
// Presets and experiments: JSON files, one for each name, in a folder of their kind.
//
// The search takes the first match of
//   PROJECT/KIND              when the working folder is a project of the user's (shoal new)
//   PROGRAM/KIND              beside the program: a copy of a few files, without an installation
//   PROGRAM/../share/shoal/KIND   an installation; a build folder, too, has this
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace shoal {

// Its presence makes the working folder a project.
inline constexpr char kProjectFile[] = "shoal-project.json";

// `kind`: "presets" or "experiments". Whether or not they exist.
std::vector<std::filesystem::path> SharedDataFolders(const std::string& kind);
// Names of what there is, sorted.
std::vector<std::string> ListSharedData(const std::string& kind);
// The file of that name; nothing where there is none. A name with '/' is never found: nothing
// outside the folders is reached.
std::optional<std::filesystem::path> FindSharedData(const std::string& kind,
                                                    const std::string& name);

}  // namespace shoal

// SPDX-License-Identifier: Apache-2.0
// Makes a project for the user from the template in the shared data: a task
// (docs/examples/point_reach), a preset, an experiment, and build files.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// Makes the complete folder or nothing. Throws Error (usage) if the folder exists or its parent
// does not; (run-time) if the template is missing or a file cannot be written.
void NewProject(const std::filesystem::path& folder);

// The commands that build and train the project in `folder`, as shell text. They name the prefix of
// the CMake package unless CMake finds the package by itself. If there is no such package, the text
// states this and what to install. Throws Error if there is no template.
std::string NextSteps(const std::filesystem::path& folder);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
// Makes a project for the user from the template in the shared data: a task
// (docs/examples/point_reach), a preset, an experiment, and build files.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// Creates the complete folder or nothing. Throws a usage error if the folder exists or its parent
// does not exist, and a run-time error if the template is missing or a file cannot be written.
void NewProject(const std::filesystem::path& folder);

// The commands that build and train the project in `folder`, as shell text. The commands name the
// prefix of the CMake package unless CMake finds the package by itself. If there is no such
// package, the text says so and names the package to install. Throws Error if there is no template.
std::string NextSteps(const std::filesystem::path& folder);

}  // namespace shoal::launch

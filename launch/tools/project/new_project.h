// SPDX-License-Identifier: Apache-2.0
// A project of the user's, made from the template that lies among the shared data: a task of one's
// own (docs/examples/point_reach), a preset, an experiment, and how to build them.
#pragma once

#include <filesystem>
#include <string>

namespace shoal::launch {

// Makes the folder whole or not at all. Throws Error: usage when it exists or its parent does not,
// run-time when there is no template or something cannot be written.
void NewProject(const std::filesystem::path& folder);

// The commands that build and train the project in `folder`, as a shell takes them. Names the
// prefix of the CMake package unless CMake finds it by itself. If there is no such package: a line
// that says so and what to install. Throws Error when there is no template.
std::string NextSteps(const std::filesystem::path& folder);

}  // namespace shoal::launch

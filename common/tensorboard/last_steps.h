// SPDX-License-Identifier: Apache-2.0
// Finds the last step of each curve in a folder of event files, so that a resumed run does not
// write a step again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace shoal::tensorboard {

// The highest step of each scalar's tag over all event files of the folder; empty if the folder
// does not exist. Like TensorBoard, reads each file up to its first damaged record. Throws Error if
// a file cannot be read.
std::map<std::string, int64_t> LastSteps(const std::filesystem::path& folder);

}  // namespace shoal::tensorboard

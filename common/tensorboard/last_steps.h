// SPDX-License-Identifier: Apache-2.0
// Finds the last step of each curve in a folder of event files, so that a resumed run adds no step
// twice.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace shoal::tensorboard {

// The highest step of each scalar's tag over all event files of the folder; empty without the
// folder. A file is read up to its first damaged record, as TensorBoard does. Throws Error when a
// file cannot be read.
std::map<std::string, int64_t> LastSteps(const std::filesystem::path& folder);

}  // namespace shoal::tensorboard

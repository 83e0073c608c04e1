// SPDX-License-Identifier: Apache-2.0
// Checks for things that a run must not leave behind.
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace shoal::soak {

// Names of the shared memory objects of this machine.
std::set<std::string> SharedMemoryObjects();

// Throws Broken (run_under_test.h) naming leftovers of an ended run: processes, UDP ports, shared
// memory that is not in `shared_memory_before`, half-written or temporary files, and files that
// other users may write.
void CheckNothingIsLeft(const std::filesystem::path& run,
                        const std::filesystem::path& temporary_files,
                        const std::set<std::string>& shared_memory_before);

}  // namespace shoal::soak

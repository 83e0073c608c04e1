// SPDX-License-Identifier: Apache-2.0
// Common parts of the fuzz targets. Each target defines libFuzzer's entry point. If libFuzzer is
// not linked, replay_corpus.cpp calls the entry point with files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size);

namespace shoal::fuzz {

inline std::string Text(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

// Ends the process unless the error message is one non-empty line.
void CheckOneLine(std::string_view message);

// Calls `read` with the first byte and the remaining text. The message of an Error from `read` must
// be one line. Returns the result for libFuzzer.
int Try(const uint8_t* data, size_t size,
        const std::function<void(uint8_t which, const std::string& bytes)>& read);

// A folder in memory for targets that read files; one per process, removed when the process ends.
const std::filesystem::path& Scratch();
// Writes a file without fsync.
void WriteScratch(const std::filesystem::path& file, std::string_view content);

}  // namespace shoal::fuzz

// Whole-file reading and atomic writing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace shoal {

// Throws Error naming the path and the system's reason.
std::string ReadFile(const std::filesystem::path& path);

// Writes `path`.tmp-PID, fsyncs it, renames it over `path`, fsyncs the folder: a reader sees the
// old file or the new one, never a part. Throws Error; on failure the temporary file is removed.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);

// For the start of a command that writes `path` after long work: throws Error when that could not
// succeed now, because its folder is not there or may not be written to, or `path` is a folder.
void CheckWritable(const std::filesystem::path& path);

// fsync of a folder, so that a rename in it survives power loss. Throws Error.
void SyncFolder(const std::filesystem::path& folder);

// Creates a folder and its parents. Throws Error naming the path.
void MakeFolders(const std::filesystem::path& folder);

}  // namespace shoal

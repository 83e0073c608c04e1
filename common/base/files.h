// SPDX-License-Identifier: Apache-2.0
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
// old file or the new one, never a part. Its user's own (0600): runs, their keys and their weights.
// Throws Error; on failure the temporary file is removed.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);
// The same for what is made to be passed on: reports, pictures, cards, summaries. Readable by whom
// the umask of the process's start allows, as any other program's files.
void WriteFileForOthers(const std::filesystem::path& path, std::string_view content);
// Gives a file or folder of our own the permissions that that umask leaves. Throws Error.
void OpenToOthers(const std::filesystem::path& path);
// From now on everything that the process makes is its user's own (umask 077), but for what is for
// others: that keeps to the umask which was found. Once, at the start, before there are threads.
void KeepFilesPrivate();

// For the start of a command that writes `path` after long work: throws Error when that could not
// succeed now, because its folder is not there or may not be written to, or `path` is a folder.
void CheckWritable(const std::filesystem::path& path);

// fsync of a folder, so that a rename in it survives power loss. Throws Error.
void SyncFolder(const std::filesystem::path& folder);

// Creates a folder and its parents. Throws Error naming the path.
void MakeFolders(const std::filesystem::path& folder);
// Creates a folder that was not there, its user's own: `prefix` and six characters, in `parent`.
// Throws Error naming the path.
std::filesystem::path MakeFreshFolder(
    const std::string& prefix = "shoal-",
    const std::filesystem::path& parent = std::filesystem::temp_directory_path());

}  // namespace shoal

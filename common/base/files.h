// SPDX-License-Identifier: Apache-2.0
// Whole-file reading and atomic writing.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "common/base/descriptor.h"

namespace shoal {

// Opens a file that must be a regular one, with `flags` and O_CLOEXEC; O_CREAT makes it with
// `mode`. Never waits: in place of a FIFO, a socket or a device it throws Error. Every file of a
// run is opened here, or mapped by code that makes the same check.
Descriptor OpenRegular(const std::filesystem::path& path, int flags, mode_t mode = 0666);

// Throws Error naming the path and the system's reason. A pipe is read only below /dev or /proc
// (/dev/stdin, a shell's <(...)), where the user named it; elsewhere it is refused.
std::string ReadFile(const std::filesystem::path& path);

// Writes `path`.tmp-PID, fsyncs it, renames it over `path`, fsyncs the folder: a reader sees the
// old file or the new one, never a part. Permissions follow the umask. Throws Error; on failure the
// temporary file is removed.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);
// The same for keys and tokens: readable by their user alone (0600), whatever the umask.
void WriteFilePrivately(const std::filesystem::path& path, std::string_view content);
// Writes `path`.new and renames it over `path`, without fsync: a busy disk does not delay the
// caller, and a power failure may lose the file. Throws Error.
void ReplaceFile(const std::filesystem::path& path, std::string_view content);
// WriteFileAtomically for reports, pictures, cards and summaries, which are made to be passed on:
// permissions follow the umask of the process's start, also after KeepFilesPrivate.
void WriteFileForOthers(const std::filesystem::path& path, std::string_view content);
// Gives a file or folder of our own the permissions that that umask leaves. Throws Error.
void OpenToOthers(const std::filesystem::path& path);

// Remembers the process's umask. Once, at the start, before there are threads.
void NoteUmask();
// From now on everything that the process makes belongs to its user alone (umask 077), except for
// files that are made to be passed on. Child processes inherit it. For secured runs.
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

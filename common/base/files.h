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

// Opens a regular file with `flags` and O_CLOEXEC; O_CREAT creates the file with `mode`. Never
// waits: if the path is a FIFO, a socket or a device, throws Error. Every file of a run is opened
// by this function, or mapped by code that makes the same check.
Descriptor OpenRegular(const std::filesystem::path& path, int flags, mode_t mode = 0666);

// Reads a whole file. Throws Error naming the path and the system's reason. A pipe is read only if
// its path lies below /dev or /proc (/dev/stdin, a shell's <(...)), because then the user named the
// pipe; elsewhere a pipe is refused.
std::string ReadFile(const std::filesystem::path& path);

// Writes `path`.tmp-PID, calls fsync, renames the file to `path`, and calls fsync for the folder. A
// reader sees the old file or the new one, never a part of a file. Permissions follow the umask.
// Throws Error; on failure, the temporary file is removed.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);
// Does the same for keys and tokens: only the user can read the file (0600), whatever the umask.
void WriteFilePrivately(const std::filesystem::path& path, std::string_view content);
// Writes `path`.new and renames it over `path`, without fsync: a busy disk does not delay the
// caller, and a power failure may lose the file. Throws Error.
void ReplaceFile(const std::filesystem::path& path, std::string_view content);
// Does what WriteFileAtomically does, for files that users pass on: reports, pictures, cards and
// summaries. Permissions follow the umask of the process's start, even after KeepFilesPrivate.
void WriteFileForOthers(const std::filesystem::path& path, std::string_view content);
// Gives a file or folder of this process the permissions that the umask of the process's start
// allows. Throws Error.
void OpenToOthers(const std::filesystem::path& path);

// Stores the process's umask. Call it once, at the start, before there are threads.
void NoteUmask();
// Sets the umask to 077: only the user can read the files and folders that the process creates from
// now on, except files of WriteFileForOthers. Child processes inherit the umask. For secured runs.
void KeepFilesPrivate();

// Checks, at the start of a command, that the command can write `path` after its long work. Throws
// Error when the folder does not exist or is not writable, or `path` is a folder.
void CheckWritable(const std::filesystem::path& path);

// Calls fsync for a folder, so that a rename within the folder survives power loss. Throws Error.
void SyncFolder(const std::filesystem::path& folder);

// Creates a folder and its parents. Throws Error naming the path.
void MakeFolders(const std::filesystem::path& folder);
// Creates a new private folder in `parent`. Its name is `prefix` and six random characters. Throws
// Error naming the path.
std::filesystem::path MakeFreshFolder(
    const std::string& prefix = "shoal-",
    const std::filesystem::path& parent = std::filesystem::temp_directory_path());

}  // namespace shoal

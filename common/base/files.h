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

// Opens a regular file with `flags` and O_CLOEXEC; O_CREAT creates the file with `mode`. Throws
// Error if the path is a FIFO, a socket or a device, so that opening never waits. Every file of a
// run is opened by this function, or mapped by code that makes the same check.
Descriptor OpenRegular(const std::filesystem::path& path, int flags, mode_t mode = 0666);

// Reads a whole file. Throws Error naming the path and the system's reason. A pipe is accepted only
// if its path is below /dev or /proc (/dev/stdin, a shell's <(...)), because then the user chose
// the pipe.
std::string ReadFile(const std::filesystem::path& path);

// Writes `path`.tmp-PID, calls fsync, renames the file to `path`, and calls fsync for the folder. A
// reader sees the old file or the new file, never a part of a file. Permissions follow the umask.
// On failure, removes the temporary file and throws Error.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view content);
// Does the same for keys and tokens: only the user can read the file (0600). The umask has no
// effect.
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

// Stores the process's umask. Call this function once, at the start of the process, before other
// threads exist.
void NoteUmask();
// Sets the umask to 077, for secured runs. Only the user can read the files and folders that the
// process creates from now on, except files of WriteFileForOthers. Child processes inherit the
// umask.
void KeepFilesPrivate();

// Checks whether the program can write `path`. Commands call this function before long work whose
// result they write to `path`. Throws Error if the folder does not exist or is not writable, or if
// `path` is a folder.
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

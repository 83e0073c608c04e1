// SPDX-License-Identifier: Apache-2.0
#include "common/base/files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>

#include "common/base/descriptor.h"
#include "common/base/disk_steps.h"
#include "common/base/error.h"

namespace shoal {
namespace {

constexpr mode_t kPrivate = 0077;

// The mask that NoteUmask found.
std::optional<mode_t>& FoundMask() {
  static std::optional<mode_t> mask;
  return mask;
}

[[noreturn]] void Fail(const char* what, const std::filesystem::path& path, int error) {
  throw RuntimeError("{} '{}': {}", what, path.string(), std::strerror(error));
}

const char* VerbOf(int flags) {
  return (flags & O_ACCMODE) == O_RDONLY ? "cannot read" : "cannot write";
}

[[noreturn]] void RefuseKind(int flags, const std::filesystem::path& path) {
  throw RuntimeError("{} '{}': it is a pipe, a socket or a device; expected a file", VerbOf(flags),
                     path.string());
}

// Opens the path without waiting for the other end of a FIFO. Fills `status`.
Descriptor OpenNow(const std::filesystem::path& path, int flags, mode_t mode, struct stat* status) {
  Descriptor file(open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, mode));
  if (file.get() < 0 && errno == ENXIO) RefuseKind(flags, path);  // a FIFO without a reader
  if (file.get() < 0 || fstat(file.get(), status) != 0) Fail(VerbOf(flags), path, errno);
  if (S_ISDIR(status->st_mode)) Fail(VerbOf(flags), path, EISDIR);
  return file;
}

// Paths under which a user names an open pipe.
bool MayBePipe(const std::filesystem::path& path) {
  const std::string& name = path.native();
  return name.starts_with("/dev/") || name.starts_with("/proc/");
}

std::string ReadAll(int fd, const std::filesystem::path& path, size_t expected) {
  std::string content;
  content.reserve(expected);
  char block[1 << 16];
  while (true) {
    const ssize_t n = read(fd, block, sizeof block);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) Fail("cannot read", path, errno);
    if (n == 0) return content;
    content.append(block, static_cast<size_t>(n));
  }
}

// Writes everything. Returns 0 or the errno.
int WriteAll(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    content.remove_prefix(static_cast<size_t>(n));
  }
  return 0;
}

// Does what WriteAll does, but in two halves on a simulated disk.
int WriteInSteps(int fd, const std::string& path, std::string_view content) {
  const size_t half = DiskSteps::Current() == nullptr ? content.size() : content.size() / 2;
  for (const std::string_view part : {content.substr(0, half), content.substr(half)}) {
    int error = DiskStep(path);
    if (error == 0) error = WriteAll(fd, part);
    if (error != 0) return error;
  }
  return 0;
}

enum class Sync { kNo, kYes };

// Writes `temporary` and renames it over `path`.
void Replace(const std::filesystem::path& temporary, const std::filesystem::path& path,
             std::string_view content, mode_t mode, Sync sync) {
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);  // left by a process that was killed
  if (const int error = DiskStep(path)) Fail("cannot write", path, error);
  const int fd =
      open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, mode);
  if (fd < 0) Fail("cannot write", path, errno);
  int error = WriteInSteps(fd, path, content);
  if (error == 0 && sync == Sync::kYes && fsync(fd) != 0) error = errno;
  if (close(fd) != 0 && error == 0) error = errno;  // explicit, because the result counts
  if (error == 0) error = DiskStep(path);
  if (error == 0 && rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(temporary.c_str());
    Fail("cannot write", path, error);
  }
  if (sync == Sync::kYes) SyncFolder(path.has_parent_path() ? path.parent_path() : ".");
}

std::filesystem::path OwnTemporary(const std::filesystem::path& path) {
  return path.string() + ".tmp-" + std::to_string(getpid());
}

}  // namespace

Descriptor OpenRegular(const std::filesystem::path& path, int flags, mode_t mode) {
  struct stat status {};
  Descriptor file = OpenNow(path, flags, mode, &status);
  if (!S_ISREG(status.st_mode)) RefuseKind(flags, path);
  fcntl(file.get(), F_SETFL, flags & O_APPEND);  // clears O_NONBLOCK: children may inherit it
  return file;
}

std::string ReadFile(const std::filesystem::path& path) {
  struct stat status {};
  const Descriptor file = OpenNow(path, O_RDONLY, 0, &status);
  if (!S_ISREG(status.st_mode)) {
    if (!MayBePipe(path)) RefuseKind(O_RDONLY, path);
    fcntl(file.get(), F_SETFL, O_RDONLY);  // reading waits for the other end
  }
  return ReadAll(file.get(), path, static_cast<size_t>(std::max<off_t>(0, status.st_size)));
}

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  Replace(OwnTemporary(path), path, content, 0666, Sync::kYes);
}

void WriteFilePrivately(const std::filesystem::path& path, std::string_view content) {
  Replace(OwnTemporary(path), path, content, 0600, Sync::kYes);
}

void ReplaceFile(const std::filesystem::path& path, std::string_view content) {
  Replace(path.string() + ".new", path, content, 0666, Sync::kNo);
}

void WriteFileForOthers(const std::filesystem::path& path, std::string_view content) {
  WriteFileAtomically(path, content);
  OpenToOthers(path);
}

void OpenToOthers(const std::filesystem::path& path) {
  std::error_code error;
  const mode_t all = std::filesystem::is_directory(path, error) ? 0777 : 0666;
  if (chmod(path.c_str(), all & ~FoundMask().value_or(kPrivate)) != 0) {
    Fail("cannot open to others", path, errno);
  }
}

void NoteUmask() {
  // The mask can be read only by setting another one.
  const mode_t found = umask(kPrivate);
  umask(found);
  if (!FoundMask()) FoundMask() = found;
}

void KeepFilesPrivate() {
  const mode_t found = umask(kPrivate);
  if (!FoundMask()) FoundMask() = found;
}

void CheckWritable(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) Fail("cannot write", path, EISDIR);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  if (!std::filesystem::exists(folder, error)) Fail("cannot write", path, ENOENT);
  if (!std::filesystem::is_directory(folder, error)) Fail("cannot write", path, ENOTDIR);
  if (access(folder.c_str(), W_OK) != 0) Fail("cannot write", path, errno);
}

void SyncFolder(const std::filesystem::path& folder) {
  const Descriptor opened(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.get() < 0) Fail("cannot open folder", folder, errno);
  if (fsync(opened.get()) != 0) Fail("cannot sync folder", folder, errno);
}

void MakeFolders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) Fail("cannot create folder", folder, error.value());
}

std::filesystem::path MakeFreshFolder(const std::string& prefix,
                                      const std::filesystem::path& parent) {
  std::string name = (parent / (prefix + "XXXXXX")).string();
  if (mkdtemp(name.data()) == nullptr) Fail("cannot create folder", name, errno);
  return name;
}

}  // namespace shoal

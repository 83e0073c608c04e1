// SPDX-License-Identifier: Apache-2.0
#include "common/base/files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>

#include "common/base/descriptor.h"
#include "common/base/error.h"

namespace shoal {
namespace {

constexpr mode_t kPrivate = 0077;

// The umask that KeepFilesPrivate found.
std::optional<mode_t>& FoundMask() {
  static std::optional<mode_t> mask;
  return mask;
}

[[noreturn]] void Fail(const char* what, const std::filesystem::path& path, int error) {
  throw RuntimeError("{} '{}': {}", what, path.string(), std::strerror(error));
}

// Writes everything or returns the errno.
int WriteAll(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    content.remove_prefix(static_cast<size_t>(n));
  }
  return fsync(fd) == 0 ? 0 : errno;
}

}  // namespace

std::string ReadFile(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) Fail("cannot read", path, EISDIR);
  std::ifstream in(path, std::ios::binary);
  if (!in) Fail("cannot read", path, errno);
  std::ostringstream content;
  content << in.rdbuf();
  if (in.bad()) Fail("cannot read", path, errno);
  return std::move(content).str();
}

void WriteFileAtomically(const std::filesystem::path& path, std::string_view content) {
  const std::filesystem::path temporary = path.string() + ".tmp-" + std::to_string(getpid());
  const int fd = open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (fd < 0) Fail("cannot write", path, errno);
  int error = WriteAll(fd, content);
  if (close(fd) != 0 && error == 0) error = errno;  // by hand: here its result counts
  if (error == 0 && rename(temporary.c_str(), path.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(temporary.c_str());
    Fail("cannot write", path, error);
  }
  SyncFolder(path.has_parent_path() ? path.parent_path() : ".");
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

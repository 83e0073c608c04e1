// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/scratch_folder.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::launch {

ScratchFolder::ScratchFolder(const std::filesystem::path& parent)
    : path_(MakeFreshFolder("shoal-", parent)) {}

ScratchFolder ScratchFolder::WithinRun(const std::filesystem::path& run) {
  const std::filesystem::path path = run / fmt::format(".scratch.tmp-{}", getpid());
  std::error_code error;
  std::filesystem::remove_all(path, error);  // of a dead process with the same number
  if (mkdir(path.c_str(), 0700) != 0) {
    throw RuntimeError("cannot create folder '{}': {}", path.string(), std::strerror(errno));
  }
  return {path, Made{}};
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace shoal::launch

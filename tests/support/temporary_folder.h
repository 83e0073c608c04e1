// SPDX-License-Identifier: Apache-2.0
// A new folder, which the destructor removes with its content.
#pragma once

#include <filesystem>
#include <string>

#include "common/base/files.h"

namespace shoal {

class TemporaryFolder {
 public:
  TemporaryFolder() : path_(MakeFreshFolder()) {}
  TemporaryFolder(const std::string& prefix, const std::filesystem::path& parent)
      : path_(MakeFreshFolder(prefix, parent)) {}
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shoal

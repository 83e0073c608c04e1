// A folder that goes away with its owner, and with everything in it.
#pragma once

#include <filesystem>

namespace shoal::launch {

class ScratchFolder {
 public:
  // Made in `parent`; throws Error naming it when that fails.
  explicit ScratchFolder(
      const std::filesystem::path& parent = std::filesystem::temp_directory_path());
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shoal::launch

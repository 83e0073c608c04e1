// A folder of our own among the system's temporary ones.
#pragma once

#include <filesystem>

namespace shoal::launch {

// Goes away with its owner, with everything in it. Throws Error when it cannot be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace shoal::launch

#include "launch/processes/scratch_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>

#include "common/base/error.h"

namespace shoal::launch {

ScratchFolder::ScratchFolder(const std::filesystem::path& parent) {
  std::string name = (parent / "shoal-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) {
    throw RuntimeError("cannot create folder '{}': {}", name, std::strerror(errno));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace shoal::launch

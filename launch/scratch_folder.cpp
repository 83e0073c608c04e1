#include "launch/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "common/base/error.h"

namespace shoal::launch {

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "shoal-XXXXXX").string();
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

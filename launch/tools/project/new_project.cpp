// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/project/new_project.h"

#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/config/shared_data.h"
#include "launch/tools/report/command_line.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// The template's folder, in an installation or in the build folder.
fs::path Template() {
  std::string looked;
  for (const fs::path& folder : SharedDataFolders("template")) {
    std::error_code error;
    if (fs::is_regular_file(folder / kProjectFile, error)) return folder;
    looked += (looked.empty() ? "" : ", ") + folder.string();
  }
  throw RuntimeError("found no template of a project; looked in {}", looked);
}

// Copies folders and plain files. A link in the build's shared data becomes a file.
void CopyTree(const fs::path& from, const fs::path& to) {
  MakeFolders(to);
  OpenToOthers(to);
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path target = to / entry.path().filename();
    if (entry.is_directory()) {
      CopyTree(entry.path(), target);
    } else {
      WriteFileForOthers(target, ReadFile(entry.path()));
    }
  }
}

// PREFIX of PREFIX/share/shoal/template: that of an installation, or the build folder.
fs::path Prefix() {
  return fs::weakly_canonical(Template()).parent_path().parent_path().parent_path();
}

}  // namespace

std::string NextSteps(const fs::path& folder) {
  const fs::path prefix = Prefix();
  if (!fs::exists(prefix / SHOAL_CMAKE_PACKAGE)) {
    return fmt::format(
        "building it needs Shoal's CMake package, and there is no '{}': install "
        "libshoal-dev (./run package makes it)",
        (prefix / SHOAL_CMAKE_PACKAGE).string());
  }
  const bool usual = prefix == "/usr" || prefix == "/usr/local";
  const std::string where =
      usual ? "" : " " + CommandLine({"-DCMAKE_PREFIX_PATH=" + prefix.string()});
  return fmt::format(
      "next: {} && cmake -B build{} && cmake --build build && shoal train --preset point-reach",
      CommandLine({"cd", folder.string()}), where);
}

void NewProject(const fs::path& given) {
  // "robot/" is the folder robot, whose parent is not robot itself.
  const fs::path absolute = fs::absolute(given).lexically_normal();
  const fs::path folder = absolute.has_filename() ? absolute : absolute.parent_path();
  std::error_code error;
  if (fs::exists(folder, error)) throw UsageError("{}: it exists already", given.string());
  if (!fs::is_directory(folder.parent_path(), error)) {
    throw UsageError("{}: there is no folder {}", given.string(), folder.parent_path().string());
  }
  const fs::path source = Template();
  fs::path half = folder;
  half += fmt::format(".tmp-{}", getpid());
  try {
    CopyTree(source, half);
    fs::rename(half, folder);
  } catch (const std::exception& e) {
    fs::remove_all(half, error);
    throw RuntimeError("{}: {}", given.string(), e.what());
  }
}

}  // namespace shoal::launch

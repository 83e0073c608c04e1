// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/served_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>

#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostListed = 200;
constexpr size_t kLongestName = 128;

struct Kind {
  std::string_view folder, extension;  // folder: "" = the run's folder
  const char* type;
};

constexpr Kind kKinds[] = {
    {kVideoFolder, ".mp4", "video/mp4"}, {"", ".html", "text/html; charset=utf-8"},
    {"", ".svg", "image/svg+xml"},       {"", ".png", "image/png"},
    {"plots", ".svg", "image/svg+xml"},  {"plots", ".png", "image/png"},
};

// True if the name is not hidden and has no character that is special in a path or a terminal.
bool PlainName(std::string_view name) {
  constexpr std::string_view kSigns = "._-+=";
  return !name.empty() && name.size() <= kLongestName && name[0] != '.' &&
         std::ranges::all_of(name, [&](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  kSigns.find(c) != std::string_view::npos;
         });
}

const Kind* KindOf(std::string_view folder, std::string_view name) {
  if (!PlainName(name)) return nullptr;
  for (const Kind& kind : kKinds) {
    if (kind.folder == folder && name.ends_with(kind.extension)) return &kind;
  }
  return nullptr;
}

// Opens a plain file in an open folder.
std::optional<ServedFile> OpenIn(int folder, const char* name, const char* type) {
  // O_NONBLOCK: opening a pipe would wait for its writer.
  Descriptor file(openat(folder, name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (file.get() < 0 || fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) {
    return std::nullopt;
  }
  return ServedFile{std::move(file), static_cast<uint64_t>(status.st_size), type};
}

}  // namespace

std::optional<ServedFile> OpenServedFile(const fs::path& run, std::string_view path) {
  const size_t slash = path.find('/');
  const std::string folder(slash == std::string_view::npos ? "" : path.substr(0, slash));
  const std::string name(slash == std::string_view::npos ? path : path.substr(slash + 1));
  const Kind* kind = KindOf(folder, name);
  if (kind == nullptr) return std::nullopt;
  // Opens each part without following links, so that the file that was checked is the file that is
  // opened.
  Descriptor in(open(run.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (in.get() >= 0 && !folder.empty()) {
    in = Descriptor(
        openat(in.get(), folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  }
  if (in.get() < 0) return std::nullopt;
  return OpenIn(in.get(), name.c_str(), kind->type);
}

std::optional<ServedFile> OpenWholeFile(const fs::path& file, const char* type) {
  return OpenIn(AT_FDCWD, file.c_str(), type);
}

std::vector<ServedName> ListServedFiles(const fs::path& run) {
  std::vector<ServedName> found;
  for (const std::string folder : {"", kVideoFolder, "plots"}) {
    std::error_code error;
    for (fs::directory_iterator it(run / folder, error), end; !error && it != end;
         it.increment(error)) {
      const std::string name = it->path().filename().string();
      const std::string path = folder.empty() ? name : folder + "/" + name;
      const auto file = OpenServedFile(run, path);
      struct stat status {};
      if (!file || fstat(file->file.get(), &status) != 0) continue;
      found.push_back({path, file->bytes, static_cast<double>(status.st_mtim.tv_sec)});
    }
  }
  std::ranges::sort(found, [](const ServedName& a, const ServedName& b) {
    return a.modified != b.modified ? a.modified > b.modified : a.path < b.path;
  });
  if (found.size() > kMostListed) found.resize(kMostListed);
  return found;
}

}  // namespace shoal::launch

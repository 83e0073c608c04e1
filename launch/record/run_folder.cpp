// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_folder.h"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr int kMostNumbers = 10'000;

// Returns false if the folder exists already. Throws Error if it cannot be created.
bool MakeNewFolder(const fs::path& path) {
  MakeFolders(path.parent_path());
  std::error_code error;
  const bool made = fs::create_directory(path, error);
  if (error) throw RuntimeError("cannot create folder '{}': {}", path.string(), error.message());
  return made;
}

void Remove(const fs::path& path) {
  std::error_code error;
  if (!IsRun(path) && !fs::is_empty(path, error)) {
    throw UsageError("'{}' is not a run (no {}): not overwritten", path.string(), kConfigFile);
  }
  fs::remove_all(path, error);
  if (error) throw RuntimeError("cannot remove '{}': {}", path.string(), error.message());
}

bool Has(const fs::path& folder, const std::string& file) {
  std::error_code error;
  return fs::is_regular_file(folder / file, error);
}

// Whether permissions prevent finding or reading the file.
bool IsForbiddenFile(const fs::path& file) {
  return faccessat(AT_FDCWD, file.c_str(), R_OK, AT_EACCESS) != 0 && errno == EACCES;
}

// Shortens "runs/x/" and "runs/./x" to "runs/x". Resolves paths without a name, such as ".".
fs::path Tidied(const fs::path& path) {
  fs::path tidy = path.lexically_normal();
  if (!tidy.has_filename()) tidy = tidy.parent_path();
  return tidy.empty() || tidy.filename() == "." || tidy.filename() == ".."
             ? fs::weakly_canonical(path)
             : tidy;
}

}  // namespace

NamedKind RunsIn(const fs::path& dir) { return {.noun = "run", .dir = dir, .file = kConfigFile}; }

fs::path FindNamed(const std::string& name_or_folder, std::span<const NamedKind> kinds) {
  std::vector<std::string> nouns, looked_at, files;
  const auto look = [&](const fs::path& path) {
    std::string text = fmt::format("'{}'", path.string());
    if (std::ranges::count(looked_at, text) == 0) looked_at.push_back(std::move(text));
  };
  for (const NamedKind& kind : kinds) {
    fs::path path = kind.dir / name_or_folder;
    if (Has(path, kind.file)) return path;
    nouns.push_back(kind.noun);
    look(path);
    files.push_back(kind.file);
  }
  look(name_or_folder);
  for (const NamedKind& kind : kinds) {
    if (Has(name_or_folder, kind.file)) return name_or_folder;
  }
  for (const NamedKind& kind : kinds) {
    for (const fs::path& folder : {kind.dir / name_or_folder, fs::path(name_or_folder)}) {
      if (!IsForbiddenFile(folder / kind.file)) continue;
      throw RuntimeError("{} '{}': permission denied", kind.noun, folder.string());
    }
  }
  throw UsageError("no {} '{}': there is no {} in {}", fmt::join(nouns, " or "), name_or_folder,
                   fmt::join(files, " or "), fmt::join(looked_at, ", "));
}

// Checkpoint folders contain config.json too, but also a state file.
bool IsRun(const fs::path& folder) { return Has(folder, kConfigFile) && !Has(folder, kStateFile); }

bool IsForbidden(const fs::path& folder) { return IsForbiddenFile(folder / kConfigFile); }

bool IsHeld(const fs::path& run) { return IsLocked(run / kRunLockFile); }

RunFolder RunFolder::Create(const fs::path& dir, const std::string& name, bool overwrite) {
  const fs::path path = dir / name;
  if (!MakeNewFolder(path)) {
    if (!overwrite) {
      throw UsageError("run '{}' exists: choose another --run-name, --resume it or --overwrite it",
                       path.string());
    }
    { const RunFolder held(path); }  // throws if the run is running
    Remove(path);
    MakeNewFolder(path);
  }
  return RunFolder(path);
}

RunFolder RunFolder::CreateNumbered(const fs::path& dir, const std::string& base) {
  for (int number = 1; number <= kMostNumbers; ++number) {
    const fs::path path = dir / (number == 1 ? base : fmt::format("{}-{}", base, number));
    if (MakeNewFolder(path)) return RunFolder(path);
  }
  throw UsageError("'{}' holds {} runs called {}: choose a --run-name", dir.string(), kMostNumbers,
                   base);
}

RunFolder RunFolder::Reopen(const fs::path& dir, const std::string& run) {
  return RunFolder(Tidied(FindNamed(run, RunsIn(dir))));
}

RunFolder::RunFolder(fs::path path)
    : path_(std::move(path)), lock_(FileLock::Take(path_ / kRunLockFile)) {
  if (!lock_) {
    throw UsageError("run '{}' is running (its coordinator holds {})", path_.string(),
                     (path_ / kRunLockFile).string());
  }
  for (const char* folder : {kLogFolder, kEvaluationFolder, kCheckpointFolder, kMadeFolder})
    MakeFolders(path_ / folder);
}

fs::path LogFile(const fs::path& run, const std::string& process) {
  return run / kLogFolder / (process + ".log");
}

fs::path NewestCheckpoint(const fs::path& run) {
  fs::path newest;
  std::optional<uint64_t> newest_updates;
  std::error_code error;
  for (fs::directory_iterator it(run / kCheckpointFolder, error), end; !error && it != end;
       it.increment(error)) {
    const std::optional<uint64_t> updates = CheckpointUpdates(it->path().filename());
    if (updates > newest_updates) {
      newest_updates = updates;
      newest = it->path();
    }
  }
  return newest;
}

fs::path JudgedCheckpoint(const fs::path& run) {
  const fs::path best = run / kCheckpointFolder / kBestCheckpoint;
  std::error_code error;
  return fs::is_directory(best, error) ? best : NewestCheckpoint(run);
}

std::vector<fs::path> FilmsOf(const fs::path& run) {
  std::vector<fs::path> films;
  std::error_code error;
  for (fs::directory_iterator it(run / kVideoFolder, error), end; !error && it != end;
       it.increment(error)) {
    if (it->path().extension() == ".mp4") films.push_back(it->path());
  }
  std::ranges::sort(films);
  return films;
}

}  // namespace shoal::launch

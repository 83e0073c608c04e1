// SPDX-License-Identifier: Apache-2.0
#include "launch/record/named_checkpoint.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "common/base/error.h"
#include "common/checkpoint/checkpoint_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// The absolute path without a trailing slash: "best/" -> "best".
fs::path Absolute(const fs::path& path) {
  fs::path absolute = fs::absolute(path).lexically_normal();
  return absolute.has_filename() ? absolute : absolute.parent_path();
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

NamedCheckpoint Judged(const fs::path& run) {
  const fs::path checkpoint = JudgedCheckpoint(run);
  if (checkpoint.empty()) throw RuntimeError("run '{}' has no checkpoint yet", run.string());
  return {run, checkpoint};
}

std::vector<std::string> CheckpointNames(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(error)) names.push_back(it->path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

NamedCheckpoint OfRun(const fs::path& run, const std::string& name) {
  const fs::path folder = run / kCheckpointFolder;
  const bool one_name = fs::path(name).filename() == name && name != "." && name != "..";
  if (one_name && IsFolder(folder / name)) return {run, folder / name};
  const fs::path path = Absolute(name);
  if (IsFolder(path) && path.parent_path() == folder) return {run, path};
  const std::vector<std::string> names = CheckpointNames(folder);
  throw UsageError("run '{}' has no checkpoint '{}', expected one of: {}", run.string(), name,
                   names.empty() ? "none yet" : fmt::format("{}", fmt::join(names, ", ")));
}

// A copied checkpoint or a card: its own config.json replaces that of the run.
NamedCheckpoint OutsideOfRuns(const fs::path& folder) {
  const bool has_run = fs::exists(folder / kConfigFile) && fs::exists(folder / kStateFile);
  return {has_run ? folder : fs::path(), folder};
}

}  // namespace

NamedCheckpoint FindCheckpoint(const CheckpointWords& words) {
  if (words.run.empty() && words.checkpoint.empty()) {
    throw UsageError("nothing is named: expected a run (name or folder) or --checkpoint FOLDER");
  }
  const NamedKind runs = RunsIn(words.run_dir);
  if (!words.run.empty() && !words.checkpoint.empty()) {
    return OfRun(Absolute(FindNamed(words.run, runs)), words.checkpoint);
  }
  const std::string& asked = words.run.empty() ? words.checkpoint : words.run;
  for (const fs::path& path : {Absolute(fs::path(words.run_dir) / asked), Absolute(asked)}) {
    if (IsRun(path)) return Judged(path);
    if (path.parent_path().filename() == kCheckpointFolder && IsFolder(path)) {
      const fs::path run = path.parent_path().parent_path();
      if (IsRun(run)) return {run, path};
    }
  }
  if (IsFolder(asked)) return OutsideOfRuns(Absolute(asked));
  return Judged(FindNamed(asked, runs));  // its error lists the folders searched
}

}  // namespace shoal::launch

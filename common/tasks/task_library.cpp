// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task_library.h"

#include <dlfcn.h>

#include <exception>
#include <filesystem>
#include <set>

#include "common/base/error.h"

namespace shoal::tasks {

namespace {

std::string& FolderBeingLoaded() {
  static std::string folder;
  return folder;
}

void Call(const std::string& path, const EntryPoint& entry_point, void (*function)()) {
  FolderBeingLoaded() = std::filesystem::absolute(path).lexically_normal().parent_path().string();
  const auto failed = [&](const char* what) {
    FolderBeingLoaded().clear();
    return UsageError("{} '{}': {}: {}", entry_point.key, path, entry_point.function, what);
  };
  try {
    function();
  } catch (const std::exception& error) {
    throw failed(error.what());
  } catch (...) {
    throw failed("threw what is no std::exception");
  }
  FolderBeingLoaded().clear();
}

}  // namespace

const std::string& LoadingFolder() { return FolderBeingLoaded(); }

void LoadTaskLibrary(const std::string& path) {
  if (!path.empty()) CallEntryPoint(path, {.function = "ShoalRegisterGoals"});
}

void CallEntryPoint(const std::string& path, const EntryPoint& entry_point) {
  // Without a slash, the loader would search the system's folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  // All symbols are resolved at once, so that a library of other sources fails here, with the
  // symbol's name. The library stays loaded, because tasks live as long as the process.
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw UsageError("{}: cannot load {}", entry_point.key, dlerror());
  static std::set<void*> called;  // the loader returns one handle for one file, whatever its path
  if (!called.insert(library).second) return;
  void* symbol = dlsym(library, entry_point.function);
  if (symbol == nullptr) {
    throw UsageError("{}: '{}' has no entry point {} ({})", entry_point.key, path,
                     entry_point.function, entry_point.page);
  }
  Call(path, entry_point, reinterpret_cast<void (*)()>(symbol));
}

}  // namespace shoal::tasks

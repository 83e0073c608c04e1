// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task_library.h"

#include <dlfcn.h>

#include <set>

#include "common/base/error.h"

namespace shoal::tasks {

void LoadTaskLibrary(const std::string& path) {
  if (!path.empty()) CallEntryPoint(path, "ShoalRegisterGoals");
}

void CallEntryPoint(const std::string& path, const char* entry_point) {
  // Without a slash the loader would search the system's folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  // Everything is resolved at once, so that a library of other sources fails here and by name. It
  // stays loaded: tasks live as long as the process.
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw UsageError("task_library: cannot load {}", dlerror());
  static std::set<void*> called;  // the loader gives one handle for one file, however it is named
  if (!called.insert(library).second) return;
  void* symbol = dlsym(library, entry_point);
  if (symbol == nullptr) {
    throw UsageError("task_library: '{}' has no entry point {} (docs/own_task.md)", path,
                     entry_point);
  }
  reinterpret_cast<void (*)()>(symbol)();
}

}  // namespace shoal::tasks

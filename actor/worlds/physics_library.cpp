// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/physics_library.h"

#include <filesystem>

#include "common/tasks/task_library.h"

namespace shoal::worlds {

void LoadTasks(const std::string& task_library) {
  if (task_library.empty()) return;
  tasks::LoadTaskLibrary(task_library);
  std::filesystem::path physics = task_library;
  physics.replace_filename(physics.stem().string() + "_physics" + physics.extension().string());
  tasks::CallEntryPoint(physics.string(), {.function = "ShoalRegisterPhysics"});
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Loads tasks that are not part of Shoal from shared objects: see docs/own_task.md.
//
//   NAME.so          goal halves. Every program of a run loads this file, so that the replay can
//                    compute rewards.
//     extern "C" void ShoalRegisterGoals();     calls tasks::AddTask for each task
//   NAME_physics.so  physics halves, in the same folder. Only programs that step environments load
//                    this file.
//     extern "C" void ShoalRegisterPhysics();   calls worlds::AddWorld for each world
//
// The shared objects use the functions of the program that loads them. They must be built from the
// same sources with the same compiler.
//
// Load task libraries at the start of a program, before other threads exist. The functions throw
// Error (kUsage), in one line that names the file, if the file cannot be loaded, if the file has no
// entry point, or if the entry point throws (for example, because a name is taken or a description
// is invalid).
#pragma once

#include <string>

namespace shoal::tasks {

// Loads the goal halves of NAME.so. Does nothing if the path is empty or if the library is already
// loaded.
void LoadTaskLibrary(const std::string& path);

// Name of the function that a shared object must define, and two names for messages: the
// configuration key that contains the path of the file, and the page of the documentation.
struct EntryPoint {
  const char* function;
  const char* key = "task_library";
  const char* page = "docs/own_task.md";
};

// Loads a shared object and calls its entry point, unless it was called before.
void CallEntryPoint(const std::string& path, const EntryPoint& entry_point);

// The absolute folder of the library whose entry point is running; model files may be in this
// folder. Empty if no entry point is running.
const std::string& LoadingFolder();

}  // namespace shoal::tasks

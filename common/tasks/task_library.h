// SPDX-License-Identifier: Apache-2.0
// Loads tasks that are not part of Shoal from shared objects: see docs/own_task.md.
//
//   NAME.so          goal halves; every program of a run loads it, so the replay can compute
//   rewards
//     extern "C" void ShoalRegisterGoals();     calls tasks::AddTask for each task
//   NAME_physics.so  physics halves, beside it; only programs that step environments load it
//     extern "C" void ShoalRegisterPhysics();   calls worlds::AddWorld for each world
//
// They use Shoal's functions as the program that loads them has them, and must be built from the
// same sources with the same compiler.
//
// At the start of a program, before threads. Errors (kUsage), in one line that names the file: a
// file that cannot be loaded, with the loader's reason; one without its entry point; whatever the
// entry point throws, such as a name that is taken or a description that cannot be.
#pragma once

#include <string>

namespace shoal::tasks {

// Loads the goal halves of NAME.so; an empty path is none. A library is loaded once.
void LoadTaskLibrary(const std::string& path);

// The function that a shared object is loaded for, and what messages call the key that names the
// file and the page about it.
struct EntryPoint {
  const char* function;
  const char* key = "task_library";
  const char* page = "docs/own_task.md";
};

// Loads a shared object and calls its entry point, unless it was called before.
void CallEntryPoint(const std::string& path, const EntryPoint& entry_point);

// While an entry point runs: the absolute folder of its library, where model files may lie beside
// it. Empty otherwise.
const std::string& LoadingFolder();

}  // namespace shoal::tasks

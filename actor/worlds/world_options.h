// SPDX-License-Identifier: Apache-2.0
// Options of a task's physics.
#pragma once

#include <string>

namespace shoal::worlds {

struct WorldOptions {
  std::string model = "";           // path of another MJCF file; empty = the task's own file
  std::string physics = "mujoco2";  // mujoco2 | mujoco3 (see fetch_weld.h)
  // Absolute folder of the task library that contains the physics half, set by MakeWorld; empty for
  // built-in physics halves.
  std::string task_folder = "";

  // The path of a file in the folder of the task library: Beside("model/arm.xml").
  std::string Beside(const std::string& file) const {
    return task_folder.empty() ? file : task_folder + "/" + file;
  }
  // The model file to load: the user's file; if there is none, `file` in the folder of the task
  // library.
  std::string ModelOr(const std::string& file) const {
    return model.empty() ? Beside(file) : model;
  }
};

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Options of a task's physics.
#pragma once

#include <string>

namespace shoal::worlds {

struct WorldOptions {
  std::string model = "";           // path of another MJCF file; empty = the task's own
  std::string physics = "mujoco2";  // mujoco2 | mujoco3 (see fetch_weld.h)
  // Absolute folder of the task library that the physics half came from, set by MakeWorld; empty
  // for the built-in ones.
  std::string task_folder = "";

  // The path of a file beside the task library: Beside("model/arm.xml").
  std::string Beside(const std::string& file) const {
    return task_folder.empty() ? file : task_folder + "/" + file;
  }
  // The model file to load: the user's, or else this one beside the task library.
  std::string ModelOr(const std::string& file) const {
    return model.empty() ? Beside(file) : model;
  }
};

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// What a user may choose about the physics of a task.
#pragma once

#include <string>

namespace shoal::worlds {

struct WorldOptions {
  std::string model;                // path of another MJCF file; empty = our own
  std::string physics = "mujoco2";  // mujoco2 | mujoco3 (see fetch_weld.h)
};

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Goal halves (task.h) of the six tasks of the DeepMind Control Suite that the PlaNet benchmark
// uses.
#pragma once

#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// cartpole_swingup, reacher_easy, cheetah_run, ball_in_cup_catch, finger_spin and walker_walk. An
// episode has 1000 control steps and never ends early. Each control step has a reward in [0, 1].
// The tasks have no goals. The action repeats, in the same order, are those of the benchmark's
// users: 8, 4, 4, 4, 2, 2.
std::vector<Task> ControlTasks();

}  // namespace shoal::tasks

// SPDX-License-Identifier: Apache-2.0
// Goal halves of six tasks of the DeepMind Control Suite, those of the PlaNet benchmark.
#pragma once

#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// cartpole_swingup, reacher_easy, cheetah_run, ball_in_cup_catch, finger_spin, walker_walk: 1000
// control steps an episode, which never ends early; a reward in [0, 1] for each of them. No goals.
// The action repeats are those of the benchmark's users: 8, 4, 4, 4, 2, 2.
std::vector<Task> ControlTasks();

}  // namespace shoal::tasks

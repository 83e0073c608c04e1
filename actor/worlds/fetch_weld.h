// SPDX-License-Identifier: Apache-2.0
// The weld that pulls the gripper towards the mocap body, with the behaviour of MuJoCo 2 or 3.
//
// MuJoCo versions before 3.0 give a weld's three rotation rows the body's translational inverse
// weight in place of the rotational inverse weight. For the Fetch gripper the two weights differ by
// a factor
// r = 16.5. If orientation and position conflict, orientation therefore prevails, and the arm stops
// short at the limits of its reach. For a comparison with published results, choose the version of
// those results.
//
// Two constraints in place of one give MuJoCo 3's behaviour in version 2:
//   - the weld itself, made softer so that its rotation rows are right: at both ends of the range
//     the impedance d becomes d' = 1 / (1 + r (1-d)/d);
//   - a `connect` between the same bodies that restores the translational stiffness of the weld.
// Time constants grow by d_max / d'_max and damping ratios by sqrt(d'_max / d_max), so that the
// reference acceleration stays the same. The inverse weights depend only on masses and inertias.
#pragma once

#include <string>

#include "actor/worlds/world.h"

namespace shoal::worlds {

enum class Physics { kMujoco2, kMujoco3 };

// Parses "mujoco2" or "mujoco3"; throws Error (kUsage) on other names.
Physics ParsePhysics(const std::string& name);

// Additional MJCF for a Fetch model: a document with the `connect` for kMujoco3, empty for
// kMujoco2.
std::string WeldAddition(Physics physics);

// Sets the weld's target to "the gripper's frame equals the mocap body's", independent of the poses
// in the model, and its stiffness according to `physics`. kMujoco3 needs a model that was loaded
// with WeldAddition. Throws Error if there is no weld between the two bodies.
void PrepareWeld(World* world, int mocap_body, int gripper_body, Physics physics);

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// The weld that pulls the gripper towards the mocap body, as MuJoCo 2 or as MuJoCo 3 solves it.
//
// Every version before 3.0 gives a weld's three rotation rows the body's translational inverse
// weight in place of the rotational one. For the Fetch gripper the two differ by a factor r = 16.5,
// so orientation wins over position when they conflict, and the arm stops short at the limits of
// its reach. Which of the two is meant depends on what results are compared with.
//
// MuJoCo 3's behaviour is had from version 2 with two constraints in place of one:
//   - the weld itself, softened until its rotation rows are right: impedance d' = 1 / (1 + r
//   (1-d)/d)
//     for d at both ends of the range;
//   - a `connect` between the same bodies that gives back the translational stiffness the weld has
//     lost.
// Time constants grow by d_max / d'_max and damping ratios by sqrt(d'_max / d_max), so that the
// reference acceleration stays the same. The inverse weights follow from masses and inertias alone.
#pragma once

#include <string>

#include "actor/worlds/world.h"

namespace shoal::worlds {

enum class Physics { kMujoco2, kMujoco3 };

// "mujoco2" or "mujoco3"; throws Error (kUsage) otherwise.
Physics ParsePhysics(const std::string& name);

// MJCF that a Fetch model needs besides its own: empty, or a document with the `connect`.
std::string WeldAddition(Physics physics);

// Makes the weld mean "the gripper's frame equals the mocap body's", whatever poses the model was
// compiled with, and as stiff as `physics` says; kMujoco3 needs a model loaded with WeldAddition.
// Throws Error when there is no weld between the two bodies.
void PrepareWeld(World* world, int mocap_body, int gripper_body, Physics physics);

}  // namespace shoal::worlds

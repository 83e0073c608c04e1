// SPDX-License-Identifier: Apache-2.0
// Refuses models of users that a task cannot drive.
#pragma once

struct mjModel_;

namespace shoal::worlds {

// Throws Error naming both sides unless the model has `joints` coordinates, as many velocities, and
// `actuators` actuators.
void CheckModelSizes(const mjModel_& model, int joints, int actuators);

}  // namespace shoal::worlds

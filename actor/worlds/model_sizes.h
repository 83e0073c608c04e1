// SPDX-License-Identifier: Apache-2.0
// Check that a user's model has the sizes that a task needs.
#pragma once

struct mjModel_;

namespace shoal::worlds {

// Throws Error naming both sizes unless the model has `joints` coordinates, as many velocities, and
// `actuators` actuators.
void CheckModelSizes(const mjModel_& model, int joints, int actuators);

}  // namespace shoal::worlds

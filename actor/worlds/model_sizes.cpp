// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/model_sizes.h"

#include <mujoco/mujoco.h>

#include "common/base/error.h"

namespace shoal::worlds {

void CheckModelSizes(const mjModel_& model, int joints, int actuators) {
  if (model.nq == joints && model.nv == joints && model.nu == actuators) return;
  throw RuntimeError(
      "the model has {} coordinates, {} velocities and {} actuators; expected {}, {} and {}",
      model.nq, model.nv, model.nu, joints, joints, actuators);
}

}  // namespace shoal::worlds

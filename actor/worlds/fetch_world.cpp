// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_world.h"

#include <mujoco/mujoco.h>

#include "actor/worlds/fetch_weld.h"
#include "actor/worlds/model_loading.h"

namespace shoal::worlds {

FetchWorld::FetchWorld(const std::string& model_name, const WorldOptions& options,
                       const FetchArmSetup& setup, std::span<const CameraView> cameras)
    : World(LoadModel(model_name, options.model, WeldAddition(ParsePhysics(options.physics))),
            options.model),
      arm_(this, setup, ParsePhysics(options.physics)),
      cameras_(cameras),
      target_site_(SiteId("target0")) {}

void FetchWorld::ResetTo(const std::array<double, 3>& goal,
                         const std::array<double, 2>& object_xy) {
  goal_ = goal;
  arm_.RestoreInitialState();
  PlaceObject(object_xy);
  // The body that carries the target's marker neither moves nor turns.
  const double* body = model().body_pos + 3 * model().site_bodyid[target_site_];
  PlaceSite(target_site_, std::array{goal[0] - body[0], goal[1] - body[1], goal[2] - body[2]});
  mj_forward(&model(), &data());
}

bool FetchWorld::HideGoal() {
  model().site_rgba[4 * target_site_ + 3] = 0;
  return true;
}

World::Outcome FetchWorld::Step(std::span<const double> action) {
  arm_.Act(action);
  Advance(FetchArm::kEngineStepsPerEnvStep);
  arm_.FinishStep();
  return {};
}

}  // namespace shoal::worlds

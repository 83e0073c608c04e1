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
  // The target's marker sits on a body that neither moves nor turns.
  const double* body = model().body_pos + 3 * model().site_bodyid[target_site_];
  for (int i = 0; i < 3; ++i) {
    model().site_pos[3 * target_site_ + i] = goal[static_cast<size_t>(i)] - body[i];
  }
  mj_forward(&model(), &data());
}

World::Outcome FetchWorld::Step(std::span<const double> action) {
  arm_.Act(action);
  Advance(FetchArm::kEngineStepsPerEnvStep);
  arm_.FinishStep();
  return {};
}

}  // namespace shoal::worlds

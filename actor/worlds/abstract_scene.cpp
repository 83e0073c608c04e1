// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/abstract_scene.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "actor/worlds/mounted_view.h"
#include "common/base/check.h"

namespace shoal::worlds {
namespace {

// Spare geoms for decoration, beside the geoms and sites of a user's model.
constexpr int kSpareGeoms = 100;

mjvCamera EngineCamera(const CameraView& camera) {
  mjvCamera view;
  mjv_defaultCamera(&view);
  if (camera.model_camera >= 0) {
    view.type = mjCAMERA_FIXED;  // in the engine, any camera of the model
    view.fixedcamid = camera.model_camera;
    return view;
  }
  view.type = mjCAMERA_FREE;
  std::copy(camera.lookat.begin(), camera.lookat.end(), view.lookat);
  view.distance = camera.distance;
  view.azimuth = camera.azimuth_degrees;
  view.elevation = camera.elevation_degrees;
  return view;
}

}  // namespace

struct AbstractScene::State {
  mjvScene scene;
  mjvOption option;
};

AbstractScene::AbstractScene() : state_(std::make_unique<State>()) {
  mjv_defaultScene(&state_->scene);
  mjv_defaultOption(&state_->option);
}

AbstractScene::~AbstractScene() { mjv_freeScene(&state_->scene); }

mjvScene& AbstractScene::scene() { return state_->scene; }

void AbstractScene::Allocate(const World& world) {
  const mjModel& model = world.model();
  mjv_makeScene(&model, &state_->scene, model.ngeom + model.nsite + kSpareGeoms);
}

void AbstractScene::Update(World* world, const CameraView& camera) {
  CHECK(state_->scene.maxgeom > 0) << "a scene without room";
  mjvCamera view = EngineCamera(camera);
  mjv_updateScene(&world->model(), &world->data(), &state_->option, /*pert=*/nullptr, &view,
                  mjCAT_ALL, &state_->scene);
  if (!camera.body.empty()) {
    MountCamera(world->model(), world->data(), camera, &state_->scene);
  }
}

}  // namespace shoal::worlds

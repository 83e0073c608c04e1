// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/model_cameras.h"

#include <mujoco/mujoco.h>

#include "common/base/error.h"

namespace shoal::worlds {

std::vector<CameraView> NamedCameras(const mjModel_& model) {
  std::vector<CameraView> cameras;
  for (int i = 0; i < model.ncam; ++i) {
    const char* name = mj_id2name(&model, mjOBJ_CAMERA, i);
    if (name == nullptr || *name == '\0') continue;
    cameras.push_back({.name = name, .model_camera = i});
  }
  return cameras;
}

std::vector<CameraView> ModelCameras(const mjModel_& model) {
  std::vector<CameraView> cameras = NamedCameras(model);
  if (cameras.empty()) throw RuntimeError("the model has no named camera");
  return cameras;
}

}  // namespace shoal::worlds

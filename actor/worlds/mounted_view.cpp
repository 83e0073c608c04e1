// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/mounted_view.h"

#include <mujoco/mujoco.h>

#include <array>
#include <cmath>
#include <numbers>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

using Vector = std::array<double, 3>;

int BodyOf(const mjModel& model, const CameraView& camera) {
  return mj_name2id(&model, mjOBJ_BODY, camera.body.c_str());
}

// Position of a free camera, with its forward and up directions.
struct Pose {
  Vector position, forward, up;
};

Pose FreePose(const CameraView& camera) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double azimuth = camera.azimuth_degrees * kDegree;
  const double elevation = camera.elevation_degrees * kDegree;
  const double ca = std::cos(azimuth), sa = std::sin(azimuth);
  const double ce = std::cos(elevation), se = std::sin(elevation);
  Pose pose{
      .position = camera.lookat, .forward = {ce * ca, ce * sa, se}, .up = {-se * ca, -se * sa, ce}};
  for (size_t i = 0; i < 3; ++i) pose.position[i] -= camera.distance * pose.forward[i];
  return pose;
}

}  // namespace

void CheckMount(const mjModel& model, const CameraView& camera) {
  if (camera.body.empty() || BodyOf(model, camera) >= 0) return;
  throw UsageError("camera '{}' is mounted on body '{}', which the model does not have",
                   camera.name, camera.body);
}

void MountCamera(const mjModel& model, const mjData& data, const CameraView& camera,
                 mjvScene* scene) {
  const int body = BodyOf(model, camera);
  CHECK(body >= 0) << camera.name << " on " << camera.body;
  const Pose pose = FreePose(camera);
  mjtNum position[3], forward[3], up[3];
  mju_rotVecMat(position, pose.position.data(), data.xmat + 9 * body);
  mju_addTo3(position, data.xpos + 3 * body);
  mju_rotVecMat(forward, pose.forward.data(), data.xmat + 9 * body);
  mju_rotVecMat(up, pose.up.data(), data.xmat + 9 * body);
  for (mjvGLCamera& eye : scene->camera) {
    mju_n2f(eye.pos, position, 3);
    mju_n2f(eye.forward, forward, 3);
    mju_n2f(eye.up, up, 3);
  }
  for (int i = 0; i < scene->nlight; ++i) {
    mjvLight& light = scene->lights[i];
    if (!light.headlight) continue;
    mju_n2f(light.pos, position, 3);
    mju_n2f(light.dir, forward, 3);
  }
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/custom_cameras.h"

#include <fmt/ranges.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "actor/worlds/model_cameras.h"
#include "actor/worlds/mounted_view.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

CameraView ViewOf(const std::string& name, const CustomCamera& camera) {
  return {.name = name,
          .lookat = camera.lookat,
          .distance = camera.distance,
          .azimuth_degrees = camera.azimuth,
          .elevation_degrees = camera.elevation,
          .body = camera.body};
}

std::vector<std::string> NamesOf(const std::vector<CameraView>& cameras) {
  std::vector<std::string> names;
  names.reserve(cameras.size());
  for (const CameraView& camera : cameras) names.push_back(camera.name);
  return names;
}

CameraView Named(const World& world, const ObservationConfig& observation,
                 const std::string& name) {
  const auto& custom = observation.custom_cameras;
  for (const CameraView& camera : world.cameras()) {
    if (custom.contains(camera.name)) {
      throw UsageError(
          "observation.custom_cameras: '{}' is a camera of the task; take another name",
          camera.name);
    }
    if (camera.name == name) return camera;
  }
  if (const auto own = custom.find(name); own != custom.end()) return ViewOf(name, own->second);
  const std::vector<CameraView> all = CamerasOf(world);
  if (const auto found = std::ranges::find(all, name, &CameraView::name); found != all.end()) {
    return *found;
  }
  std::vector<std::string> names = NamesOf(all);
  for (const auto& [own, camera] : custom) names.push_back(own);
  throw UsageError("unknown camera '{}' (observation.cameras); cameras of this task: {}", name,
                   fmt::join(names, ", "));
}

}  // namespace

std::vector<CameraView> CamerasOf(const World& world) {
  std::vector<CameraView> all(world.cameras().begin(), world.cameras().end());
  for (CameraView& camera : NamedCameras(world.model())) {
    if (std::ranges::find(all, camera.name, &CameraView::name) == all.end()) {
      all.push_back(std::move(camera));
    }
  }
  return all;
}

CameraView DefaultCamera(const World& world) {
  const std::vector<CameraView> all = CamerasOf(world);
  if (!all.empty()) return all.front();
  throw UsageError(
      "the task has no camera: World::cameras() is empty and {} names none; expected one of them, "
      "observation.custom_cameras, or observation.pixels=false",
      world.source());
}

CameraView FindCamera(const World& world, const std::string& name) {
  const std::vector<CameraView> all = CamerasOf(world);
  if (const auto found = std::ranges::find(all, name, &CameraView::name); found != all.end()) {
    return *found;
  }
  throw UsageError("unknown camera '{}'; cameras of this task: {}", name,
                   fmt::join(NamesOf(all), ", "));
}

CameraView ChooseCamera(const World& world, const ObservationConfig& observation,
                        const std::string& name) {
  CameraView view = Named(world, observation, name);
  CheckMount(world.model(), view);
  return view;
}

std::vector<std::string> ChooseCameras(const World& world, const ObservationConfig& observation) {
  if (observation.cameras != ObservationConfig().cameras) return observation.cameras;
  const std::vector<std::string> names = NamesOf(CamerasOf(world));
  // The default names cameras of the Fetch tasks; other tasks may lack them.
  const bool all = std::ranges::all_of(observation.cameras, [&](const std::string& name) {
    return observation.custom_cameras.contains(name) ||
           std::ranges::find(names, name) != names.end();
  });
  if (all) return observation.cameras;
  return {DefaultCamera(world).name};
}

void CheckCameras(const World& world) {
  std::set<std::string> names;
  for (const CameraView& camera : world.cameras()) {
    if (camera.name.empty()) throw UsageError("World::cameras(): a camera has no name");
    if (!names.insert(camera.name).second) {
      throw UsageError("World::cameras(): two cameras have the name '{}'", camera.name);
    }
    if (camera.model_camera >= world.model().ncam) {
      throw UsageError("World::cameras(): '{}' is camera {} of the model, which has {}",
                       camera.name, camera.model_camera, world.model().ncam);
    }
    if (camera.model_camera >= 0) continue;
    const bool finite =
        std::ranges::all_of(camera.lookat, [](double x) { return std::isfinite(x); }) &&
        std::isfinite(camera.azimuth_degrees) && std::isfinite(camera.elevation_degrees);
    if (!finite || !(camera.distance > 0) || !std::isfinite(camera.distance)) {
      throw UsageError(
          "World::cameras(): '{}' looks at ({}) from {} m, azimuth {}, elevation {}; expected "
          "finite "
          "numbers and a positive distance",
          camera.name, fmt::join(camera.lookat, ", "), camera.distance, camera.azimuth_degrees,
          camera.elevation_degrees);
    }
  }
}

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/custom_cameras.h"

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

CameraView Named(const World& world, const ObservationConfig& observation,
                 const std::string& name) {
  const auto& custom = observation.custom_cameras;
  const CameraView* found = nullptr;
  std::string names;
  for (const CameraView& camera : world.cameras()) {
    if (custom.contains(camera.name)) {
      throw UsageError(
          "observation.custom_cameras: '{}' is a camera of the task; take another name",
          camera.name);
    }
    if (camera.name == name) found = &camera;
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  if (found != nullptr) return *found;
  if (const auto own = custom.find(name); own != custom.end()) return ViewOf(name, own->second);
  for (const auto& [own, camera] : custom) names += (names.empty() ? "" : ", ") + own;
  throw UsageError("unknown camera '{}' (observation.cameras); cameras of this task: {}", name,
                   names);
}

}  // namespace

CameraView ChooseCamera(const World& world, const ObservationConfig& observation,
                        const std::string& name) {
  CameraView view = Named(world, observation, name);
  CheckMount(world.model(), view);
  return view;
}

}  // namespace shoal::worlds

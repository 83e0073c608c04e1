#include "actor/worlds/custom_cameras.h"

#include "common/base/error.h"

namespace shoal::worlds {

CameraView ChooseCamera(const World& world, const ObservationConfig& observation,
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
  if (const auto own = custom.find(name); own != custom.end()) {
    const CustomCamera& camera = own->second;
    CameraView view;
    view.name = name;
    view.lookat = camera.lookat;
    view.distance = camera.distance;
    view.azimuth_degrees = camera.azimuth;
    view.elevation_degrees = camera.elevation;
    return view;
  }
  for (const auto& [own, camera] : custom) names += (names.empty() ? "" : ", ") + own;
  throw UsageError("unknown camera '{}' (observation.cameras); cameras of this task: {}", name,
                   names);
}

}  // namespace shoal::worlds

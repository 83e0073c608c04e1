#include "actor/worlds/world_registry.h"

#include "actor/worlds/fetch_object_world.h"
#include "actor/worlds/fetch_reach.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

struct Registration {
  const char* name;
  std::unique_ptr<World> (*make)(const WorldOptions& options);
  bool has_mujoco3 = false;  // physics besides mujoco2
};

constexpr Registration kWorlds[] = {
    {"FetchReach", MakeFetchReach, true},
    {"FetchPush", MakeFetchPush, true},
    {"FetchSlide", MakeFetchSlide, true},
    {"FetchPickAndPlace", MakeFetchPickAndPlace, true},
};

}  // namespace

std::unique_ptr<World> MakeWorld(const std::string& name, const WorldOptions& options) {
  for (const Registration& world : kWorlds) {
    if (name != world.name) continue;
    if (options.physics != "mujoco2" && !world.has_mujoco3) {
      throw UsageError("physics is '{}'; {} has mujoco2 only", options.physics, name);
    }
    return world.make(options);
  }
  CHECK(false) << "no physics half named " << name;
  return nullptr;
}

const CameraView& FindCamera(const World& world, const std::string& name) {
  std::string names;
  for (const CameraView& camera : world.cameras()) {
    if (camera.name == name) return camera;
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  throw UsageError("unknown camera '{}'; cameras of this task: {}", name, names);
}

}  // namespace shoal::worlds

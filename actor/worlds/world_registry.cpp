// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/world_registry.h"

#include <algorithm>
#include <map>
#include <utility>

#include "actor/worlds/ball_in_cup_catch.h"
#include "actor/worlds/cartpole_swingup.h"
#include "actor/worlds/cheetah_run.h"
#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/fetch_object_world.h"
#include "actor/worlds/fetch_reach.h"
#include "actor/worlds/finger_spin.h"
#include "actor/worlds/hopper.h"
#include "actor/worlds/reacher_easy.h"
#include "actor/worlds/walker_walk.h"
#include "common/base/error.h"
#include "common/tasks/task_library.h"

namespace shoal::worlds {
namespace {

struct Registration {
  const char* name;
  std::unique_ptr<World> (*make)(const WorldOptions& options);
  bool has_mujoco3 = false;  // whether physics mujoco3 can be chosen
};

// Adapts the maker of a world without a choice of physics.
template <std::unique_ptr<World> (*make)(const std::string& model_file)>
std::unique_ptr<World> OfModel(const WorldOptions& options) {
  return make(options.model);
}

constexpr Registration kWorlds[] = {
    {"FetchReach", MakeFetchReach, true},
    {"FetchPush", MakeFetchPush, true},
    {"FetchSlide", MakeFetchSlide, true},
    {"FetchPickAndPlace", MakeFetchPickAndPlace, true},
    {"Hopper-v4", OfModel<MakeHopperV4>},
    {"Hopper-v5", OfModel<MakeHopperV5>},
    {"CustomHopper-source", OfModel<MakeCustomHopperSource>},
    {"CustomHopper-target", OfModel<MakeCustomHopperTarget>},
    {"cartpole_swingup", OfModel<MakeCartpoleSwingup>},
    {"reacher_easy", OfModel<MakeReacherEasy>},
    {"cheetah_run", OfModel<MakeCheetahRun>},
    {"ball_in_cup_catch", OfModel<MakeBallInCupCatch>},
    {"finger_spin", OfModel<MakeFingerSpin>},
    {"walker_walk", OfModel<MakeWalkerWalk>},
};

// A world registered by AddWorld.
struct AddedWorld {
  WorldMaker make;
  std::string task_folder;
};
std::map<std::string, AddedWorld>& AddedWorlds() {
  static std::map<std::string, AddedWorld> worlds;
  return worlds;
}

std::unique_ptr<World> MakeAdded(const std::string& name, const AddedWorld& added,
                                 WorldOptions options) {
  options.task_folder = added.task_folder;
  std::unique_ptr<World> world = added.make(options);
  if (world == nullptr) {
    throw UsageError("physics half '{}': the function given to AddWorld returned no world", name);
  }
  CheckCameras(*world);
  return world;
}

bool IsOurs(const std::string& name) {
  return std::ranges::any_of(kWorlds,
                             [&](const Registration& world) { return name == world.name; });
}

}  // namespace

void AddWorld(const std::string& name, WorldMaker physics_half) {
  if (name.empty() || physics_half == nullptr) {
    throw UsageError("AddWorld: physics half '{}': expected a name and a function", name);
  }
  if (IsOurs(name) ||
      !AddedWorlds().emplace(name, AddedWorld{physics_half, tasks::LoadingFolder()}).second) {
    throw UsageError("there is a physics half '{}' already", name);
  }
}

std::unique_ptr<World> MakeWorld(const std::string& name, const WorldOptions& options) {
  for (const Registration& world : kWorlds) {
    if (name != world.name) continue;
    if (options.physics != "mujoco2" && !world.has_mujoco3) {
      throw UsageError("physics is '{}'; {} has mujoco2 only", options.physics, name);
    }
    return world.make(options);
  }
  if (const auto added = AddedWorlds().find(name); added != AddedWorlds().end()) {
    return MakeAdded(name, added->second, options);
  }
  throw UsageError("there is no physics half '{}': its goal half is registered, but no world",
                   name);
}

}  // namespace shoal::worlds

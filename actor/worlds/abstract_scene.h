// SPDX-License-Identifier: Apache-2.0
// The engine's abstract scene of a world: its geoms, lights and camera, before anything is drawn.
#pragma once

#include <memory>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/world.h"

struct mjvScene_;

namespace shoal::worlds {

class AbstractScene {
 public:
  AbstractScene();
  ~AbstractScene();
  AbstractScene(const AbstractScene&) = delete;
  AbstractScene& operator=(const AbstractScene&) = delete;

  // Allocates memory for all geoms that the model may show. Resets the scene's flags.
  void Allocate(const World& world);
  // Updates the scene to the world's current state, seen by `camera`. CHECK: Allocate was called.
  void Update(World* world, const CameraView& camera);

  mjvScene_& scene();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shoal::worlds

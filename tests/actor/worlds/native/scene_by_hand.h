// SPDX-License-Identifier: Apache-2.0
// Abstract scenes of the engine, built without a model.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "actor/worlds/native/renderer.h"

namespace shoal::worlds::native {

// The eye is at the origin and looks along +x, z is up; at distance 1 the view reaches 1/2 up, down
// and (in square pictures) to the sides. One directional light shines along the gaze.
class SceneByHand {
 public:
  SceneByHand() {
    mjv_defaultScene(&scene_);
    mjvGLCamera& camera = scene_.camera[0];
    const float forward[] = {1, 0, 0}, up[] = {0, 0, 1};
    std::memcpy(camera.forward, forward, sizeof(forward));
    std::memcpy(camera.up, up, sizeof(up));
    camera.frustum_near = 0.1f;
    camera.frustum_far = 100;
    camera.frustum_top = 0.05f;
    camera.frustum_bottom = -0.05f;
    scene_.camera[1] = camera;
    scene_.nlight = 1;
    mjvLight& light = scene_.lights[0];
    light = {};
    light.headlight = light.directional = 1;
    light.dir[0] = 1;
    light.attenuation[0] = 1;
    for (int c = 0; c < 3; ++c) {
      light.ambient[c] = 0.2f;
      light.diffuse[c] = 0.7f;
      light.specular[c] = 0.3f;
    }
  }
  SceneByHand(const SceneByHand&) = delete;
  SceneByHand& operator=(const SceneByHand&) = delete;

  // Adds a white geom without specular reflection, aligned with the world's axes. The reference is
  // valid until the next Add.
  mjvGeom& Add(int type, std::array<float, 3> position, std::array<float, 3> size) {
    mjvGeom& geom = geoms_.emplace_back();
    std::memset(static_cast<void*>(&geom), 0, sizeof(geom));
    geom.type = type;
    geom.objtype = mjOBJ_GEOM;
    geom.objid = geom.segid = static_cast<int>(geoms_.size()) - 1;
    geom.category = mjCAT_DYNAMIC;
    geom.dataid = geom.texid = -1;
    for (size_t i = 0; i < 3; ++i) {
      geom.pos[i] = position[i];
      geom.size[i] = size[i];
    }
    geom.mat[0] = geom.mat[4] = geom.mat[8] = 1;
    for (float& channel : geom.rgba) channel = 1;
    return geom;
  }

  std::vector<mjvGeom>& geoms() { return geoms_; }
  mjvScene& scene() {
    scene_.geoms = geoms_.data();
    scene_.ngeom = static_cast<int>(geoms_.size());
    return scene_;
  }

 private:
  mjvScene scene_;
  std::vector<mjvGeom> geoms_;
};

// A model without geoms and textures.
inline mjModel EmptyModel() {
  mjModel model;
  std::memset(static_cast<void*>(&model), 0, sizeof(model));
  return model;
}

inline std::vector<InstructionSet> SupportedSets() {
  std::vector<InstructionSet> sets;
  for (const auto set : {InstructionSet::kSse2, InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (Supported(set)) sets.push_back(set);
  }
  return sets;
}

}  // namespace shoal::worlds::native

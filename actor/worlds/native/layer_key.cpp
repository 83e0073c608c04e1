// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/layer_key.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>

namespace shoal::worlds::native {

void MakeLayerKey(const mjvScene& scene, const CameraFrame& frame, const View& view,
                  std::span<const int> fixed, StaticLayers::Key* key) {
  key->clear();
  const auto add_words = [key](const void* data, size_t bytes) {
    const size_t at = key->size();
    key->resize(at + bytes / sizeof(uint32_t));
    std::memcpy(key->data() + at, data, bytes);
  };
  const auto add = [key](std::initializer_list<int> words) {
    for (const int word : words) key->push_back(static_cast<uint32_t>(word));
  };
  add_words(&frame, sizeof(frame));
  add({view.width, view.height, scene.nlight});
  for (int i = 0; i < std::min(scene.nlight, mjMAXLIGHT); ++i) {
    const mjvLight& light = scene.lights[i];
    // The members from attenuation to specular are contiguous.
    add_words(light.attenuation, sizeof(float) * (3 + 2 + 9));
    add({light.headlight, light.directional, light.castshadow});
    if (light.headlight) continue;  // its position is the camera's
    add_words(light.pos, sizeof(light.pos));
    add_words(light.dir, sizeof(light.dir));
  }
  for (const int i : fixed) {
    const mjvGeom& geom = scene.geoms[i];
    add({i, geom.type, geom.dataid, geom.texid, geom.texuniform, geom.texcoord});
    // The members from texrepeat to reflectance are contiguous.
    add_words(geom.texrepeat, sizeof(float) * (2 + 3 + 3 + 9 + 4 + 4));
  }
}

}  // namespace shoal::worlds::native

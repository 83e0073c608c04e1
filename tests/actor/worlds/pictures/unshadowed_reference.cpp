// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/pictures/unshadowed_reference.h"

#include <GL/osmesa.h>
#include <mujoco/mujoco.h>

#include <cstdlib>

#include "actor/worlds/frame_packing.h"
#include "common/base/check.h"

namespace shoal::worlds::native {

struct UnshadowedReference::State {
  int width, height;
  OSMesaContext osmesa;
  std::vector<uint8_t> window, pixels;
  mjrContext context;

  void Render(mjvScene* scene) {
    CHECK(OSMesaMakeCurrent(osmesa, window.data(), GL_UNSIGNED_BYTE, width, height) == GL_TRUE);
    scene->flags[mjRND_REFLECTION] = 0;
    const mjrRect viewport{0, 0, width, height};
    mjr_render(viewport, scene, &context);
    mjr_readPixels(pixels.data(), nullptr, viewport, &context);
  }
};

UnshadowedReference::UnshadowedReference(mjModel* of, int width, int height)
    : state_(std::make_unique<State>()) {
  setenv("LP_NUM_THREADS", "0", /*overwrite=*/1);
  State& state = *state_;
  state.width = width;
  state.height = height;
  const auto pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  state.window.resize(4 * pixels);
  state.pixels.resize(3 * pixels);
  state.osmesa = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 8, nullptr);
  CHECK(state.osmesa != nullptr);
  CHECK(OSMesaMakeCurrent(state.osmesa, state.window.data(), GL_UNSIGNED_BYTE, width, height) ==
        GL_TRUE);
  mjr_defaultContext(&state.context);
  mjModel& model = *of;
  const auto kept = model.vis;
  model.vis.quality.offsamples = 0;
  // Lights that cast shadows keep their passes, but the shadow map covers next to nothing.
  model.vis.quality.shadowsize = 64;
  model.vis.map.shadowclip = 1e-6f;
  model.vis.map.shadowscale = 1e-3f;
  model.vis.global.offwidth = width;
  model.vis.global.offheight = height;
  mjr_makeContext(&model, &state.context, mjFONTSCALE_50);
  mjr_setBuffer(mjFB_OFFSCREEN, &state.context);
  model.vis = kept;
}

UnshadowedReference::~UnshadowedReference() {
  mjr_freeContext(&state_->context);
  OSMesaDestroyContext(state_->osmesa);
}

std::vector<uint8_t> UnshadowedReference::Draw(mjvScene* scene) {
  state_->Render(scene);
  std::vector<uint8_t> planes(state_->pixels.size());
  PackRgb(state_->pixels, state_->height, state_->width, planes);
  return planes;
}

std::vector<int> UnshadowedReference::DrawSegments(mjvScene* scene) {
  scene->flags[mjRND_SEGMENT] = scene->flags[mjRND_IDCOLOR] = 1;
  const std::vector<uint8_t> planes = Draw(scene);
  scene->flags[mjRND_SEGMENT] = scene->flags[mjRND_IDCOLOR] = 0;
  const size_t count = planes.size() / 3;
  std::vector<int> segments(count);
  for (size_t i = 0; i < count; ++i) {
    segments[i] = (planes[i] | planes[count + i] << 8 | planes[2 * count + i] << 16) - 1;
  }
  return segments;
}

}  // namespace shoal::worlds::native

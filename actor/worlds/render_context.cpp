// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/render_context.h"

#include <GL/gl.h>
#include <GL/osmesa.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "actor/worlds/engine_messages.h"
#include "actor/worlds/frame_packing.h"
#include "actor/worlds/low_poly_shapes.h"
#include "actor/worlds/mounted_view.h"
#include "actor/worlds/scene_culling.h"
#include "common/base/check.h"
#include "common/base/error.h"

#ifdef __SANITIZE_ADDRESS__
// OSMesa keeps a few hundred bytes of every context it destroys.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa.so\n"; }
#endif

namespace shoal::worlds {
namespace {

// Tessellation of quality `fast`. Stacks, of spheres, decide what a goal just above the table shows
// of itself: with three, a cap of 4 mm is a point that no pixel sees. More of either takes longer
// and looks the same at 84x84.
constexpr int kFastSlices = 10;
constexpr int kFastStacks = 4;
constexpr int kFastLinkSlices = 8;  // of cylinders and capsules
constexpr int kFastQuads = 1;
constexpr double kFastPlaneLines = 10;  // of a plane's grid, on each side of its centre
constexpr int kDepthBits = 24, kStencilBits = 8, kAccumulationBits = 8;
// Room for decoration that a user's model may add to its own geoms and sites.
constexpr int kSpareGeoms = 100;

bool AnyLightCastsShadow(const mjModel& model) {
  return std::any_of(model.light_castshadow, model.light_castshadow + model.nlight,
                     [](mjtByte casts) { return casts != 0; });
}

bool AllLightsAreDirectional(const mjModel& model) {
  return std::all_of(model.light_directional, model.light_directional + model.nlight,
                     [](mjtByte directional) { return directional != 0; });
}

// While it lives, planes have wide grids. A plane's third size is the spacing at which the engine
// divides it for drawing: Hopper's floor becomes 26,000 quads of 0.25 m, for a light that is the
// same everywhere on it.
class WidePlaneGrids {
 public:
  explicit WidePlaneGrids(mjModel* model)
      : model_(model), sizes_(model->geom_size, model->geom_size + 3 * model->ngeom) {
    for (int i = 0; i < model->ngeom; ++i) {
      mjtNum* size = model->geom_size + 3 * i;
      if (model->geom_type[i] != mjGEOM_PLANE) continue;
      size[2] = std::max(size[2], std::max(size[0], size[1]) / kFastPlaneLines);
    }
  }
  ~WidePlaneGrids() { std::copy(sizes_.begin(), sizes_.end(), model_->geom_size); }
  WidePlaneGrids(const WidePlaneGrids&) = delete;
  WidePlaneGrids& operator=(const WidePlaneGrids&) = delete;

 private:
  mjModel* model_;
  std::vector<mjtNum> sizes_;
};

mjvCamera EngineCamera(const CameraView& camera) {
  mjvCamera view;
  mjv_defaultCamera(&view);
  if (camera.model_camera >= 0) {
    view.type = mjCAMERA_FIXED;  // the engine's word for any camera of the model
    view.fixedcamid = camera.model_camera;
    return view;
  }
  view.type = mjCAMERA_FREE;
  std::copy(camera.lookat.begin(), camera.lookat.end(), view.lookat);
  view.distance = camera.distance;
  view.azimuth = camera.azimuth_degrees;
  view.elevation = camera.elevation_degrees;
  return view;
}

// Where a light casts shadows the engine adds its part in a pass of its own, after texturing: a
// textured floor is brighter than full light times its texture. Without that pass the parts are
// summed before texturing, where the sum would be cut off at full light.
void LeaveLightUnclamped() {
  constexpr GLenum kClampVertexColor = 0x891A;
  const auto clamp_color =
      reinterpret_cast<void (*)(GLenum, GLenum)>(OSMesaGetProcAddress("glClampColorARB"));
  if (clamp_color == nullptr) throw RuntimeError("OSMesa has no glClampColorARB");
  clamp_color(kClampVertexColor, GL_FALSE);
}

// The pass without shadow casters is cut off at full light all the same.
void LimitHeadlight(mjvScene* scene) {
  for (int i = 0; i < scene->nlight; ++i) {
    mjvLight& light = scene->lights[i];
    if (!light.headlight) continue;
    for (int channel = 0; channel < 3; ++channel) {
      light.diffuse[channel] = std::min(light.diffuse[channel], 1 - light.ambient[channel]);
    }
  }
}

}  // namespace

struct RenderContext::Engine {
  OSMesaContext osmesa = nullptr;
  std::vector<uint8_t> window;  // OSMesa's own buffer; drawing goes to the engine's off-screen one
  mjrContext context;
  mjvScene scene;
  mjvOption option;
  LowPolyShapes shapes{kFastLinkSlices};

  Engine() {
    mjr_defaultContext(&context);
    mjv_defaultScene(&scene);
    mjv_defaultOption(&option);
  }
};

RenderContext::RenderContext(const ObservationConfig& observation)
    : width_(observation.width),
      height_(observation.height),
      grey_(observation.grey),
      fast_(observation.quality == "fast"),
      pixels_(static_cast<size_t>(width_) * static_cast<size_t>(height_) * 3),
      engine_(std::make_unique<Engine>()) {
  CHECK(width_ > 0 && height_ > 0) << width_ << " x " << height_;
  if (!fast_ && observation.quality != "reference") {
    throw UsageError("observation.quality is '{}'; expected fast or reference",
                     observation.quality);
  }
  InstallEngineCallbacks();
  setenv("LP_NUM_THREADS", "0", /*overwrite=*/1);
  engine_->osmesa = OSMesaCreateContextExt(OSMESA_RGBA, kDepthBits, kStencilBits, kAccumulationBits,
                                           /*sharelist=*/nullptr);
  if (engine_->osmesa == nullptr) throw RuntimeError("OSMesa makes no context");
  engine_->window.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_) * 4);
}

RenderContext::~RenderContext() {
  MakeCurrent();
  mjr_freeContext(&engine_->context);
  mjv_freeScene(&engine_->scene);
  OSMesaDestroyContext(engine_->osmesa);
}

void RenderContext::MakeCurrent() {
  if (OSMesaGetCurrentContext() == engine_->osmesa) return;
  CHECK(OSMesaMakeCurrent(engine_->osmesa, engine_->window.data(), GL_UNSIGNED_BYTE, width_,
                          height_) == GL_TRUE)
      << "OSMesa context of " << width_ << " x " << height_;
}

void RenderContext::Attach(World* world) {
  if (!fingerprint_.empty()) {
    if (world->fingerprint() != fingerprint_) {
      throw RuntimeError("a render context draws one model: it has {}, an environment brings {}",
                         fingerprint_, world->fingerprint());
    }
    return;
  }
  CHECK(!world->textures_released()) << "a model without textures";
  mjModel& model = world->model();
  auto& quality = model.vis.quality;
  // A shadow map that nothing uses would take 64 MB.
  if (fast_ || !AnyLightCastsShadow(model)) quality.shadowsize = 0;
  if (fast_) {
    quality.offsamples = 0;
    quality.numslices = kFastSlices;
    quality.numstacks = kFastStacks;
    // Light that falls off over a box needs the box's own division.
    if (!AnyLightCastsShadow(model)) quality.numquads = kFastQuads;
  }
  model.vis.global.offwidth = width_;
  model.vis.global.offheight = height_;

  MakeCurrent();
  mjrContext& context = engine_->context;
  // Light that falls off over a floor needs the floor's own division.
  std::optional<WidePlaneGrids> wide;
  if (fast_ && AllLightsAreDirectional(model)) wide.emplace(&model);
  mjr_makeContext(&model, &context, mjFONTSCALE_50);
  mjr_setBuffer(mjFB_OFFSCREEN, &context);
  if (context.currentBuffer != mjFB_OFFSCREEN) {
    throw RuntimeError("OSMesa has no off-screen buffer of {} x {}", width_, height_);
  }
  mjvScene& scene = engine_->scene;
  mjv_makeScene(&model, &scene, model.ngeom + model.nsite + kSpareGeoms);
  if (fast_) {
    scene.flags[mjRND_SHADOW] = 0;
    scene.flags[mjRND_REFLECTION] = 0;
    light_unclamped_ = AnyLightCastsShadow(model);
    if (light_unclamped_) LeaveLightUnclamped();
    // The sky is most of a picture's fragments: the nearest texel is enough for it.
    for (int i = 0; i < context.ntexture; ++i) {
      if (context.textureType[i] != mjTEXTURE_SKYBOX) continue;
      glBindTexture(GL_TEXTURE_CUBE_MAP, context.texture[i]);
      glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
      glTexParameteri(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
      glBindTexture(GL_TEXTURE_CUBE_MAP, 0);
    }
  }
  fingerprint_ = world->fingerprint();
}

void RenderContext::Draw(World* world, const CameraView& camera) {
  mjvCamera view = EngineCamera(camera);
  mjv_updateScene(&world->model(), &world->data(), &engine_->option, /*pert=*/nullptr, &view,
                  mjCAT_ALL, &engine_->scene);
  if (!camera.body.empty()) {
    MountCamera(world->model(), world->data(), camera, &engine_->scene);
  }
  if (light_unclamped_) LimitHeadlight(&engine_->scene);
  if (fast_) {
    RemoveUnseenGeoms(&engine_->scene, static_cast<float>(width_) / static_cast<float>(height_));
    engine_->shapes.Replace(engine_->context, &engine_->scene);
  }
  const mjrRect viewport{0, 0, width_, height_};
  mjr_render(viewport, &engine_->scene, &engine_->context);
  mjr_readPixels(pixels_.data(), nullptr, viewport, &engine_->context);
}

void RenderContext::Render(World* world, std::span<const CameraView> cameras,
                           std::span<uint8_t> frame) {
  CHECK(world->fingerprint() == fingerprint_) << "render before attach";
  const size_t bytes = static_cast<size_t>(channels_per_camera()) * static_cast<size_t>(height_) *
                       static_cast<size_t>(width_);
  CHECK(frame.size() == cameras.size() * bytes) << frame.size() << " bytes for " << cameras.size();
  MakeCurrent();
  for (size_t i = 0; i < cameras.size(); ++i) {
    Draw(world, cameras[i]);
    const std::span<uint8_t> planes = frame.subspan(i * bytes, bytes);
    grey_ ? PackGrey(pixels_, height_, width_, planes) : PackRgb(pixels_, height_, width_, planes);
  }
}

std::shared_ptr<RenderContext> MakeRenderContext(const ObservationConfig& observation) {
  return std::make_shared<RenderContext>(observation);
}

}  // namespace shoal::worlds

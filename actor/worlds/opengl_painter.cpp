// SPDX-License-Identifier: Apache-2.0
// Qualities fast and reference: the engine's OpenGL renderer in OSMesa.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <vector>

#include "actor/worlds/abstract_scene.h"
#include "actor/worlds/frame_packing.h"
#include "actor/worlds/low_poly_shapes.h"
#include "actor/worlds/osmesa_library.h"
#include "actor/worlds/painter.h"
#include "actor/worlds/scene_culling.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/config/config.h"

#ifdef __SANITIZE_ADDRESS__
// OSMesa leaks a few hundred bytes of every destroyed context.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libOSMesa.so\n"; }
#endif

namespace shoal::worlds {
namespace {

// Tessellation of quality `fast`. The stacks of a sphere decide how much of a goal just above the
// table is visible: with three stacks, a cap of 4 mm is a point that no pixel sees. More slices or
// stacks take longer and look the same at 84x84.
constexpr int kFastSlices = 10;
constexpr int kFastStacks = 4;
constexpr int kFastLinkSlices = 8;  // for cylinders and capsules
constexpr int kFastQuads = 1;
constexpr double kFastPlaneLines = 10;  // grid lines of a plane on each side of its centre
constexpr int kDepthBits = 24, kStencilBits = 8, kAccumulationBits = 8;

bool AnyLightCastsShadow(const mjModel& model) {
  return std::any_of(model.light_castshadow, model.light_castshadow + model.nlight,
                     [](mjtByte casts) { return casts != 0; });
}

bool AllLightsAreDirectional(const mjModel& model) {
  return std::all_of(model.light_directional, model.light_directional + model.nlight,
                     [](mjtByte directional) { return directional != 0; });
}

// Gives planes wide grids during its lifetime. A plane's third size is the spacing at which the
// engine divides it for drawing. Hopper's floor would become 26,000 quads of 0.25 m although its
// light is uniform.
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

// The engine adds a light that casts shadows in a separate pass, after texturing. A textured floor
// is then brighter than full light times its texture. Without that pass, the parts are summed
// before texturing and the sum would be clamped to full light.
void LeaveLightUnclamped() {
  constexpr GLenum kClampVertexColor = 0x891A;
  const auto clamp_color =
      reinterpret_cast<void (*)(GLenum, GLenum)>(Osmesa().proc_address("glClampColorARB"));
  if (clamp_color == nullptr) throw RuntimeError("OSMesa has no glClampColorARB");
  clamp_color(kClampVertexColor, GL_FALSE);
}

// The pass without shadow casters is clamped to full light in either case.
void LimitHeadlight(mjvScene* scene) {
  for (int i = 0; i < scene->nlight; ++i) {
    mjvLight& light = scene->lights[i];
    if (!light.headlight) continue;
    for (int channel = 0; channel < 3; ++channel) {
      light.diffuse[channel] = std::min(light.diffuse[channel], 1 - light.ambient[channel]);
    }
  }
}

class OpenGlPainter final : public Painter {
 public:
  explicit OpenGlPainter(const ObservationConfig& observation);
  ~OpenGlPainter() override;

  void TakeModel(World* world) override;
  void Draw(World* world, const CameraView& camera, std::span<uint8_t> planes) override;

 private:
  void MakeCurrent();
  void MakeContext(World* world);
  void LeaveOutEffects(const mjModel& model);

  int width_, height_;
  bool grey_;
  bool fast_;
  bool light_unclamped_ = false;  // replaces the passes of lights that cast shadows
  std::vector<uint8_t> pixels_;   // (H, W, 3), row 0 = bottom, as the engine reads them
  const OsmesaLibrary& gl_ = Osmesa();
  OSMesaContext osmesa_ = nullptr;
  std::vector<uint8_t> window_;  // OSMesa's own buffer; the engine draws to its off-screen buffer
  mjrContext context_;
  AbstractScene scene_;
  LowPolyShapes shapes_{kFastLinkSlices};
};

OpenGlPainter::OpenGlPainter(const ObservationConfig& observation)
    : width_(observation.width),
      height_(observation.height),
      grey_(observation.grey),
      fast_(observation.quality == "fast"),
      pixels_(static_cast<size_t>(width_) * static_cast<size_t>(height_) * 3) {
  mjr_defaultContext(&context_);
  // At this size the rasteriser's threads cost more than they gain, and actors already use one core
  // each.
  setenv("LP_NUM_THREADS", "0", /*overwrite=*/1);
  osmesa_ = gl_.create_context(OSMESA_RGBA, kDepthBits, kStencilBits, kAccumulationBits,
                               /*sharelist=*/nullptr);
  if (osmesa_ == nullptr) throw RuntimeError("OSMesa makes no context");
  window_.resize(static_cast<size_t>(width_) * static_cast<size_t>(height_) * 4);
}

OpenGlPainter::~OpenGlPainter() {
  MakeCurrent();
  mjr_freeContext(&context_);
  gl_.destroy_context(osmesa_);
}

void OpenGlPainter::MakeCurrent() {
  if (gl_.current_context() == osmesa_) return;
  CHECK(gl_.make_current(osmesa_, window_.data(), GL_UNSIGNED_BYTE, width_, height_) == GL_TRUE)
      << "OSMesa context of " << width_ << " x " << height_;
}

void OpenGlPainter::MakeContext(World* world) {
  mjModel& model = world->model();
  auto& quality = model.vis.quality;
  // A shadow map takes 64 MB, also if it is unused.
  if (fast_ || !AnyLightCastsShadow(model)) quality.shadowsize = 0;
  if (fast_) {
    quality.offsamples = 0;
    quality.numslices = kFastSlices;
    quality.numstacks = kFastStacks;
    // If the light on a box varies, the box needs its own division.
    if (!AnyLightCastsShadow(model)) quality.numquads = kFastQuads;
  }
  model.vis.global.offwidth = width_;
  model.vis.global.offheight = height_;
  // If the light on a floor varies, the floor needs its own division.
  std::optional<WidePlaneGrids> wide;
  if (fast_ && AllLightsAreDirectional(model)) wide.emplace(&model);
  mjr_makeContext(&model, &context_, mjFONTSCALE_50);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
  if (context_.currentBuffer != mjFB_OFFSCREEN) {
    throw RuntimeError("OSMesa has no off-screen buffer of {} x {}", width_, height_);
  }
}

void OpenGlPainter::LeaveOutEffects(const mjModel& model) {
  scene_.scene().flags[mjRND_SHADOW] = 0;
  scene_.scene().flags[mjRND_REFLECTION] = 0;
  light_unclamped_ = AnyLightCastsShadow(model);
  if (light_unclamped_) LeaveLightUnclamped();
  // Most fragments of a picture are sky, and the nearest texel is good enough for the sky.
  for (int i = 0; i < context_.ntexture; ++i) {
    if (context_.textureType[i] != mjTEXTURE_SKYBOX) continue;
    gl_.bind_texture(GL_TEXTURE_CUBE_MAP, context_.texture[i]);
    gl_.tex_parameter(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.tex_parameter(GL_TEXTURE_CUBE_MAP, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl_.bind_texture(GL_TEXTURE_CUBE_MAP, 0);
  }
}

void OpenGlPainter::TakeModel(World* world) {
  MakeCurrent();
  MakeContext(world);
  scene_.Allocate(*world);
  if (fast_) LeaveOutEffects(world->model());
}

void OpenGlPainter::Draw(World* world, const CameraView& camera, std::span<uint8_t> planes) {
  MakeCurrent();
  scene_.Update(world, camera);
  mjvScene& scene = scene_.scene();
  if (light_unclamped_) LimitHeadlight(&scene);
  if (fast_) {
    RemoveUnseenGeoms(&scene, static_cast<float>(width_) / static_cast<float>(height_));
    shapes_.Replace(context_, &scene);
  }
  const mjrRect viewport{0, 0, width_, height_};
  mjr_render(viewport, &scene, &context_);
  mjr_readPixels(pixels_.data(), nullptr, viewport, &context_);
  grey_ ? PackGrey(pixels_, height_, width_, planes) : PackRgb(pixels_, height_, width_, planes);
}

}  // namespace

std::unique_ptr<Painter> MakeOpenGlPainter(const ObservationConfig& observation) {
  return std::make_unique<OpenGlPainter>(observation);
}

}  // namespace shoal::worlds

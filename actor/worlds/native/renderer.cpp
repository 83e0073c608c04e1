// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/renderer.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "actor/worlds/native/camera_frame.h"
#include "actor/worlds/native/drawing_order.h"
#include "actor/worlds/native/geom_rules.h"
#include "actor/worlds/native/haze_setup.h"
#include "actor/worlds/native/layer_key.h"
#include "actor/worlds/native/plane_grids.h"
#include "actor/worlds/native/shape_setup.h"
#include "actor/worlds/native/static_layers.h"
#include "actor/worlds/native/surface_setup.h"
#include "actor/worlds/native/texture_levels.h"
#include "actor/worlds/native/tile_buffer.h"
#include "actor/worlds/native/triangle_meshes.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds::native {
namespace {

constexpr float kFromBehind = 0.3f;  // alpha of a plane seen from behind
// Transparent geoms are blended twice; the colours of this many are kept for the second time.
constexpr size_t kOversKept = 16;

const Kernels& KernelsOf(InstructionSet set) {
  switch (set) {
    case InstructionSet::kAvx512:
      return kAvx512Kernels;
    case InstructionSet::kAvx2:
      return kAvx2Kernels;
    case InstructionSet::kSse2:
      break;
  }
  return kSse2Kernels;
}

}  // namespace

struct Renderer::State {
  const Kernels& kernels;
  std::vector<TextureLevels> textures;
  std::vector<const Texture*> texture_views;
  int sky = -1;  // index of its texture, -1 = none
  HazeStyle haze;
  PlaneGrids grids;
  TriangleMeshes meshes;

  uint32_t stamp = 1;  // stamp of the lights on grids; 0 = never lit
  RayTables rays;
  TileBuffer picture;
  std::vector<TileBuffer> overs;  // one transparent geom each
  StaticLayers layers;
  bool keep_layers = true;
  // The sky of the camera's last orientation, drawn once that orientation has occurred twice.
  std::vector<uint32_t> sky_key, wanted_sky;
  std::vector<int32_t> sky_picture;

  // Values of one frame.
  View view{};
  CameraFrame frame;
  DrawingOrder order;
  std::vector<TileRect> rects;  // places of transparent geoms, in drawing order
  std::vector<bool> seen;
  std::vector<LightColour> colours;
  std::vector<Surface> surfaces;
  std::vector<std::vector<Triangle>> triangles;  // for each mesh among the surfaces
  size_t meshes_used = 0;
  StaticLayers::Key key;

  State(const mjModel& model, InstructionSet set)
      : kernels(KernelsOf(set)), haze(model), grids(model), meshes(model) {}

  void NextStamp();
  void Start(const mjvScene& scene, int width, int height);
  void SetSky();
  bool MakeAnyShape(const mjvGeom& geom, const PlacedGeom& placed, int number, Shape* shape);
  SurfaceSources SourcesOf(const mjvGeom& geom, const SceneLights& lights);
  void See(const mjvScene& scene, std::span<const int> geoms, const SceneLights& lights);
  void ShadeAll(const SceneLights& lights);
  bool ShadeOver(const mjvScene& scene, const SceneLights& lights, int number, TileBuffer* over,
                 TileRect* rect);
  void DrawTransparent(const mjvScene& scene, const SceneLights& lights);
  void Clear();
  void DrawOpaque(const mjvScene& scene, const SceneLights& lights);
  void DrawHaze(const mjvScene& scene);
  void SeeEverything(const mjvScene& scene, int width, int height);
};

bool Supported(InstructionSet set) {
  __builtin_cpu_init();
  switch (set) {
    case InstructionSet::kSse2:
      return true;
    case InstructionSet::kAvx2:
      return __builtin_cpu_supports("avx2");
    case InstructionSet::kAvx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  }
  return false;
}

InstructionSet WidestInstructionSet() {
  if (Supported(InstructionSet::kAvx512)) return InstructionSet::kAvx512;
  return Supported(InstructionSet::kAvx2) ? InstructionSet::kAvx2 : InstructionSet::kSse2;
}

Renderer::Renderer(const mjModel& model, InstructionSet set) {
  CHECK(Supported(set));
  const std::string refusal = RefusalOf(model);
  if (!refusal.empty()) {
    throw UsageError(
        "observation.quality is 'native', which does not draw this model: {}; "
        "expected fast or reference",
        refusal);
  }
  state_ = std::make_unique<State>(model, set);
  State& state = *state_;
  for (int i = 0; i < model.ntex; ++i) {
    const bool cube = model.tex_type[i] != mjTEXTURE_2D;
    const size_t size =
        3 * static_cast<size_t>(model.tex_width[i]) * static_cast<size_t>(model.tex_height[i]);
    state.textures.emplace_back(std::span(model.tex_rgb + model.tex_adr[i], size),
                                model.tex_width[i], model.tex_height[i], cube);
    if (model.tex_type[i] == mjTEXTURE_SKYBOX && state.sky < 0) state.sky = i;
  }
  for (const TextureLevels& levels : state.textures) {
    state.texture_views.push_back(&levels.view());
  }
}

Renderer::~Renderer() = default;

void Renderer::ForgetLayers() {
  state_->layers = StaticLayers();
  state_->sky_key.clear();
}

void Renderer::KeepLayers(bool keep) {
  ForgetLayers();
  state_->keep_layers = keep;
}

void Renderer::State::SetSky() {
  view.sky = sky < 0 ? nullptr : texture_views[static_cast<size_t>(sky)];
  // The engine turns the sky's cube by 90 degrees about x, to (x, z, -y) of the world.
  const Vector3 rows[3] = {{frame.right.x, frame.up.x, frame.forward.x},
                           {frame.right.z, frame.up.z, frame.forward.z},
                           {-frame.right.y, -frame.up.y, -frame.forward.y}};
  for (int i = 0; i < 3; ++i) {
    view.sky_axes[i][0] = static_cast<float>(rows[i].x);
    view.sky_axes[i][1] = static_cast<float>(rows[i].y);
    view.sky_axes[i][2] = static_cast<float>(rows[i].z);
  }
}

void Renderer::State::NextStamp() {
  CHECK(++stamp != 0) << "2^32 frames of one renderer";  // old light would look current
}

void Renderer::State::Start(const mjvScene& scene, int width, int height) {
  CHECK(width > 0 && height > 0) << width << " x " << height;
  CheckFlags(scene);
  NextStamp();
  frame = FrameOf(scene, width, height);
  order.Sort(scene, frame);
  rays.Fill(frame, width, height, &view);
  SetSky();
  picture.Resize(view);
  colours.clear();
  surfaces.clear();
  meshes_used = 0;
}

bool Renderer::State::MakeAnyShape(const mjvGeom& geom, const PlacedGeom& placed, int number,
                                   Shape* shape) {
  const int id = number * kIdsPerShape;
  if (geom.type != mjGEOM_MESH && geom.type != mjGEOM_HFIELD) {
    return MakeShape(geom, placed, frame, view, id, shape);
  }
  const TriangleMesh* mesh = meshes.Find(geom);
  if (mesh == nullptr) {
    throw RuntimeError(
        "geom {} of the scene shows mesh or height field {}, which no visible geom "
        "of the model has",
        number, geom.dataid);
  }
  if (triangles.size() == meshes_used) triangles.emplace_back();
  return MakeTriangles(*mesh, placed, frame, view, id, &triangles[meshes_used++], shape);
}

SurfaceSources Renderer::State::SourcesOf(const mjvGeom& geom, const SceneLights& lights) {
  const bool is_mesh = geom.type == mjGEOM_MESH || geom.type == mjGEOM_HFIELD;
  return {&lights, texture_views, &grids, is_mesh ? meshes.Find(geom) : nullptr, stamp};
}

void Renderer::State::See(const mjvScene& scene, std::span<const int> geoms,
                          const SceneLights& lights) {
  for (const int i : geoms) {
    const mjvGeom& geom = scene.geoms[i];
    const PlacedGeom placed = Place(geom, frame);
    Shape shape;
    if (!MakeAnyShape(geom, placed, i, &shape)) continue;
    kernels.see(view, shape, picture.tiles());
    const size_t first = colours.size();
    lights.AddColours(geom, &colours);
    AddSurfaces(geom, placed, shape, SourcesOf(geom, lights), colours.data() + first,
                /*transparent=*/false, &surfaces);
  }
}

void Renderer::State::ShadeAll(const SceneLights& lights) {
  for (const Surface& surface : surfaces) {
    kernels.shade(view, lights.set(), surface, picture.tiles());
  }
  surfaces.clear();
  colours.clear();
}

void Renderer::State::Clear() {
  Tiles tiles = picture.tiles();
  if (view.sky == nullptr) return kernels.clear(view, tiles);
  // The sky depends only on the camera's orientation and the view's size.
  wanted_sky.clear();
  for (const auto& row : view.sky_axes) {
    for (const float v : row) wanted_sky.push_back(std::bit_cast<uint32_t>(v));
  }
  for (const float v : {view.pixel, view.ray_x[0], view.ray_y[0]}) {
    wanted_sky.push_back(std::bit_cast<uint32_t>(v));
  }
  wanted_sky.push_back(static_cast<uint32_t>(view.width));
  wanted_sky.push_back(static_cast<uint32_t>(view.height));
  if (!keep_layers || wanted_sky != sky_key) {
    sky_key = wanted_sky;
    sky_picture.clear();
    return kernels.clear(view, tiles);
  }
  tiles.colour = nullptr;  // the sky's colours are written next
  kernels.clear(view, tiles);
  if (sky_picture.empty()) {
    kernels.sky(view, picture.tiles());
    sky_picture = picture.colours();
  } else {
    std::copy(sky_picture.begin(), sky_picture.end(), picture.colours().begin());
  }
}

void Renderer::State::DrawOpaque(const mjvScene& scene, const SceneLights& lights) {
  const size_t most = (order.fixed.size() + order.moving.size()) * lights.lights().size();
  colours.reserve(most + lights.lights().size());
  const auto finish_sky = [this] {
    if (view.sky != nullptr && sky_picture.empty()) kernels.sky(view, picture.tiles());
  };
  bool build = false;
  if (keep_layers && !order.fixed.empty()) {
    MakeLayerKey(scene, frame, view, order.fixed, &key);
    if (const TileBuffer* layer = layers.Find(key)) {
      picture.CopyFrom(*layer);
      See(scene, order.moving, lights);
      ShadeAll(lights);
      return;
    }
    build = layers.Miss(key);
  }
  Clear();
  See(scene, order.fixed, lights);
  if (build) {
    ShadeAll(lights);
    finish_sky();
    layers.Store(key, picture, view);
  }
  See(scene, order.moving, lights);
  ShadeAll(lights);
  if (!build) finish_sky();
}

void Renderer::State::DrawHaze(const mjvScene& scene) {
  Haze made;
  if (view.sky != nullptr && MakeHaze(scene, frame, haze, &made)) {
    kernels.haze(view, made, picture.tiles());
  }
}

// Writes the geom's colours to `over` and their place to `rect`. False: the geom is not in view.
bool Renderer::State::ShadeOver(const mjvScene& scene, const SceneLights& lights, int number,
                                TileBuffer* over, TileRect* rect) {
  const mjvGeom& geom = scene.geoms[number];
  const PlacedGeom placed = Place(geom, frame);
  Shape shape;
  if (!MakeAnyShape(geom, placed, number, &shape)) return false;
  over->Resize(view);
  colours.clear();
  surfaces.clear();
  NextStamp();
  lights.AddColours(geom, &colours);
  AddSurfaces(geom, placed, shape, SourcesOf(geom, lights), colours.data(),
              /*transparent=*/true, &surfaces);
  kernels.see_over(view, shape, picture.tiles(), over->tiles());
  for (const Surface& surface : surfaces) {
    kernels.shade(view, lights.set(), surface, over->tiles());
  }
  *rect = shape.rect;
  return true;
}

// Blends twice, as the engine does: front to back, then back to front.
void Renderer::State::DrawTransparent(const mjvScene& scene, const SceneLights& lights) {
  const size_t count = order.transparent.size();
  overs.resize(std::max(overs.size(), std::min(count, kOversKept)));
  rects.resize(count);
  seen.assign(count, false);
  for (size_t turn = 0; turn < 2 * count; ++turn) {
    const bool first = turn < count;
    const size_t i = first ? turn : 2 * count - 1 - turn;
    const mjvGeom& geom = scene.geoms[order.transparent[i]];
    TileBuffer& over = overs[std::min(i, kOversKept - 1)];
    if (first || i + 1 >= kOversKept) {
      seen[i] = ShadeOver(scene, lights, order.transparent[i], &over, &rects[i]);
    }
    if (!seen[i]) continue;
    float alpha = geom.rgba[3];
    if (geom.type == mjGEOM_PLANE && IsBehind(geom, frame)) alpha *= kFromBehind;
    kernels.blend(rects[i], view.tiles_x, alpha, over.tiles(), picture.tiles());
  }
}

void Renderer::Draw(const mjvScene& scene, int width, int height, std::span<uint8_t> planes) {
  State& state = *state_;
  state.Start(scene, width, height);
  const SceneLights lights(scene, state.frame);
  state.DrawOpaque(scene, lights);
  state.DrawHaze(scene);
  state.DrawTransparent(scene, lights);
  WritePlanes(state.kernels, state.view, state.picture.tiles().colour, planes);
}

void Renderer::State::SeeEverything(const mjvScene& scene, int width, int height) {
  Start(scene, width, height);
  kernels.clear(view, picture.tiles());
  const SceneLights lights(scene, frame);
  for (const auto* geoms : {&order.fixed, &order.moving, &order.transparent}) {
    colours.reserve(colours.size() + (geoms->size() + 1) * lights.lights().size());
    See(scene, *geoms, lights);
    surfaces.clear();
    colours.clear();
  }
}

void Renderer::DrawNumbers(const mjvScene& scene, int width, int height,
                           std::span<int32_t> numbers) {
  state_->SeeEverything(scene, width, height);
  const int32_t* id = state_->picture.tiles().id;
  WriteRows(
      state_->view, [id](size_t at) { return id[at] < 0 ? -1 : id[at] / kIdsPerShape; }, numbers);
}

void Renderer::DrawDepth(const mjvScene& scene, int width, int height, std::span<float> depths) {
  state_->SeeEverything(scene, width, height);
  const float* w = state_->picture.tiles().w;
  WriteRows(
      state_->view,
      [w](size_t at) { return w[at] > 0 ? 1 / w[at] : std::numeric_limits<float>::infinity(); },
      depths);
}

}  // namespace shoal::worlds::native

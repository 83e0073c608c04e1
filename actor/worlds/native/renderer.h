// SPDX-License-Identifier: Apache-2.0
// Draws the engine's abstract scenes on a CPU, without OpenGL: quality `native`.
//
// Planes, spheres, capsules, ellipsoids, cylinders and boxes are ray cast with exact shapes, so
// edges are finer than the engine's polygons. Light, materials and textures follow the engine's
// OpenGL renderer; shadows, reflections and multisampling are left out. Frames are equal to the
// last bit on all x86-64 CPUs and for all instruction sets.
//
// One renderer draws scenes of one model. One thread at a time may use a renderer; there may be any
// number of renderers.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

struct mjModel_;
struct mjvScene_;

namespace shoal::worlds::native {

enum class InstructionSet { kSse2, kAvx2, kAvx512 };

bool Supported(InstructionSet set);
// The widest instruction set that this CPU supports.
InstructionSet WidestInstructionSet();

class Renderer {
 public:
  // Copies textures; does not refer to `model` afterwards. Throws Error (kUsage) if the model
  // cannot be drawn.
  explicit Renderer(const mjModel_& model, InstructionSet set = WidestInstructionSet());
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Draws a scene of the renderer's model to planes (3, H, W) uint8, row 0 = top. Throws Error
  // (kNonFinite) if the camera or a geom is not finite, (kRuntime) if a geom cannot be drawn or the
  // scene has fog.
  void Draw(const mjvScene_& scene, int width, int height, std::span<uint8_t> planes);

  // Writes numbers (H, W): index in scene.geoms of the nearest geom, transparent or not; -1 = the
  // sky.
  void DrawNumbers(const mjvScene_& scene, int width, int height, std::span<int32_t> numbers);
  // Writes depths (H, W): depth along the viewing direction, in m; infinite for the sky.
  void DrawDepth(const mjvScene_& scene, int width, int height, std::span<float> depths);

  // Discards stored layers, so that the next frame draws everything. For tests.
  void ForgetLayers();
  void KeepLayers(bool keep);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shoal::worlds::native

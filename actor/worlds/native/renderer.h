// SPDX-License-Identifier: Apache-2.0
// Draws the engine's abstract scenes on a CPU, without OpenGL: quality
// `native`.
//
// Planes, spheres, capsules, ellipsoids, cylinders and boxes are cast ray by
// ray, exactly, so edges are finer than the engine's polygons. Light, materials
// and textures follow the engine's OpenGL renderer; shadows, reflections and
// multisampling are left out. Frames are equal to the last bit on all x86-64
// CPUs, whichever instruction set draws them.
//
// One renderer draws scenes of one model. One thread at a time each; any number
// of them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

struct mjModel_;
struct mjvScene_;

namespace shoal::worlds::native {

enum class InstructionSet { kSse2, kAvx2, kAvx512 };

bool Supported(InstructionSet set);
// The widest that this CPU has.
InstructionSet WidestInstructionSet();

class Renderer {
 public:
  // Copies textures; keeps nothing of `model`. Throws Error (kUsage) when it
  // cannot be drawn.
  explicit Renderer(const mjModel_& model, InstructionSet set = WidestInstructionSet());
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // planes (3, H, W) uint8, row 0 = top. The scene is of the renderer's model.
  // Throws Error (kNonFinite) when the camera or a geom is not finite,
  // (kRuntime) on a geom that cannot be drawn and on a scene with fog.
  void Draw(const mjvScene_& scene, int width, int height, std::span<uint8_t> planes);

  // (H, W): index in scene.geoms of what is in front, transparent or not; -1 =
  // the sky.
  void DrawNumbers(const mjvScene_& scene, int width, int height, std::span<int32_t> numbers);
  // (H, W): depth along the gaze, in m; infinite where only the sky is.
  void DrawDepth(const mjvScene_& scene, int width, int height, std::span<float> depths);

  // Draws everything anew each time, for tests.
  void ForgetLayers();
  void KeepLayers(bool keep);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace shoal::worlds::native

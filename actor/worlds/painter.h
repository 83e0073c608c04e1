// SPDX-License-Identifier: Apache-2.0
// How one quality draws a world.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/world.h"

namespace shoal {
struct ObservationConfig;
}

namespace shoal::worlds {

// Pictures of a scene: its colours, or for people to look at:
//   kSegments  one colour for each geom, black for the sky
//   kDepths    grey, 255 times the least depth in view by the pixel's, black for the sky
enum class PainterOutput { kColours, kSegments, kDepths };

class Painter {
 public:
  virtual ~Painter() = default;

  // To be called once, before Draw. Takes textures and meshes from the world's model, which may
  // lose its textures afterwards. Throws Error when the model cannot be drawn.
  virtual void TakeModel(World* world) = 0;
  // planes (3, H, W) uint8, or (1, H, W) when the observation is grey, row 0 = top. `world` has the
  // same model.
  virtual void Draw(World* world, const CameraView& camera, std::span<uint8_t> planes) = 0;
  // From now on Draw gives this. Throws Error (kUsage) when this quality does not have it.
  virtual void SetOutput(PainterOutput output);
};

// Qualities fast and reference. Throws Error when there is no OSMesa context.
std::unique_ptr<Painter> MakeOpenGlPainter(const ObservationConfig& observation);
// Quality native.
std::unique_ptr<Painter> MakeNativePainter(const ObservationConfig& observation);

}  // namespace shoal::worlds

// SPDX-License-Identifier: Apache-2.0
// Painter: draws worlds in one rendering quality.
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

// Kinds of pictures of a scene. kSegments and kDepths are meant for people.
//   kColours   the scene's colours
//   kSegments  one colour for each geom, black for the sky
//   kDepths    grey: 255 * (least depth in view) / (depth of the pixel), black for the sky
enum class PainterOutput { kColours, kSegments, kDepths };

class Painter {
 public:
  virtual ~Painter() = default;

  // Copies textures and meshes of the world's model. Call it once, before Draw. The model's
  // textures may be released afterwards. Throws Error if the model cannot be drawn.
  virtual void TakeModel(World* world) = 0;
  // Draws `world`, which has the model of TakeModel. planes (3, H, W) uint8, or (1, H, W) if the
  // observation is grey; row 0 = top.
  virtual void Draw(World* world, const CameraView& camera, std::span<uint8_t> planes) = 0;
  // Sets the output of later calls of Draw. Throws Error (kUsage) if this quality does not have the
  // output.
  virtual void SetOutput(PainterOutput output);
};

// Painter of the qualities fast and reference. Throws Error if there is no OSMesa context.
std::unique_ptr<Painter> MakeOpenGlPainter(const ObservationConfig& observation);
// Painter of the quality native.
std::unique_ptr<Painter> MakeNativePainter(const ObservationConfig& observation);

}  // namespace shoal::worlds

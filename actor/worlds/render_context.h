// SPDX-License-Identifier: Apache-2.0
// Off-screen rendering at the size of a frame, in the quality that the configuration names.
//
// One context draws one model, because all environments of a process have copies of the same model.
// One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/painter.h"
#include "actor/worlds/world.h"

namespace shoal::worlds {

class RenderContext {
 public:
  // The qualities fast and reference set LP_NUM_THREADS=0 for the process and throw Error if there
  // is no OSMesa context.
  explicit RenderContext(const ObservationConfig& observation);
  ~RenderContext();
  RenderContext(const RenderContext&) = delete;
  RenderContext& operator=(const RenderContext&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  // Channels of one camera: 1 grey, 3 RGB.
  int channels_per_camera() const { return grey_ ? 1 : 3; }

  // Sets the output of later calls of Render. Throws Error (kUsage) if the quality has only
  // colours.
  void SetOutput(PainterOutput output) { painter_->SetOutput(output); }

  // Call it once per world before Render. Uploads the model of the first world; throws Error if a
  // later world has another model.
  void Attach(World* world);

  // Draws the world's current state, seen by each camera, to `frame` (cameras *
  // channels_per_camera, H, W), row 0 = top. CHECK on the size of `frame`.
  void Render(World* world, std::span<const CameraView> cameras, std::span<uint8_t> frame);

 private:
  int width_, height_;
  bool grey_;
  std::string fingerprint_;  // of the model, empty before the first Attach
  std::unique_ptr<Painter> painter_;
};

}  // namespace shoal::worlds

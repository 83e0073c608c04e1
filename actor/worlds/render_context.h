// SPDX-License-Identifier: Apache-2.0
// Off-screen rendering with OSMesa, at the size of a frame.
//
// One context draws one model: environments of one process hold copies of it. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "actor/worlds/camera_view.h"
#include "actor/worlds/environment.h"
#include "actor/worlds/world.h"

namespace shoal::worlds {

class RenderContext {
 public:
  // Sets LP_NUM_THREADS=0 for the process: the rasteriser's own threads cost more than they bring
  // at this size, and actors are already one per core. Throws Error when there is no OSMesa
  // context.
  explicit RenderContext(const ObservationConfig& observation);
  ~RenderContext();
  RenderContext(const RenderContext&) = delete;
  RenderContext& operator=(const RenderContext&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  // Of one camera: 1 grey, 3 RGB.
  int channels_per_camera() const { return grey_ ? 1 : 3; }

  // To be called once per world before Render. Uploads the model of the first; throws Error when a
  // later one has another model.
  void Attach(World* world);

  // frame (cameras * channels_per_camera, H, W), row 0 = top: the world's current state as each of
  // the cameras sees it. CHECK on a frame of another size.
  void Render(World* world, std::span<const CameraView> cameras, std::span<uint8_t> frame);

 private:
  struct Engine;  // MuJoCo's and OSMesa's objects

  void MakeCurrent();
  void Draw(World* world, const CameraView& camera);

  int width_, height_;
  bool grey_;
  bool fast_;
  bool light_unclamped_ = false;  // stands in for passes of lights that would cast shadows
  std::string fingerprint_;       // of the model, empty before the first Attach
  std::vector<uint8_t> pixels_;   // (H, W, 3), row 0 = bottom, as the engine reads them
  std::unique_ptr<Engine> engine_;
};

}  // namespace shoal::worlds

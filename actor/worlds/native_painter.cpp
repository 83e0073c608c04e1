// SPDX-License-Identifier: Apache-2.0
// Quality native: our own renderer, without OpenGL.
#include <optional>
#include <vector>

#include "actor/worlds/abstract_scene.h"
#include "actor/worlds/frame_packing.h"
#include "actor/worlds/native/renderer.h"
#include "actor/worlds/painter.h"
#include "common/config/config.h"

namespace shoal::worlds {
namespace {

class NativePainter final : public Painter {
 public:
  explicit NativePainter(const ObservationConfig& observation)
      : width_(observation.width), height_(observation.height) {
    if (observation.grey) {
      colours_.resize(3 * static_cast<size_t>(width_) * static_cast<size_t>(height_));
    }
  }

  void TakeModel(World* world) override {
    renderer_.emplace(world->model());
    scene_.Allocate(*world);
  }

  void Draw(World* world, const CameraView& camera, std::span<uint8_t> planes) override {
    scene_.Update(world, camera);
    if (colours_.empty()) {
      renderer_->Draw(scene_.scene(), width_, height_, planes);
    } else {
      renderer_->Draw(scene_.scene(), width_, height_, colours_);
      GreyOfPlanes(colours_, planes);
    }
  }

 private:
  int width_, height_;
  std::vector<uint8_t> colours_;  // (3, H, W); empty unless the observation is grey
  AbstractScene scene_;
  std::optional<native::Renderer> renderer_;
};

}  // namespace

std::unique_ptr<Painter> MakeNativePainter(const ObservationConfig& observation) {
  return std::make_unique<NativePainter>(observation);
}

}  // namespace shoal::worlds

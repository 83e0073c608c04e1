// SPDX-License-Identifier: Apache-2.0
// Quality native: Shoal's own renderer, without OpenGL.
#include <algorithm>
#include <cmath>
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
      : width_(observation.width), height_(observation.height), grey_(observation.grey) {
    if (grey_) colours_.resize(3 * pixels());
  }

  void TakeModel(World* world) override {
    renderer_.emplace(world->model());
    scene_.Allocate(*world);
  }

  void Draw(World* world, const CameraView& camera, std::span<uint8_t> planes) override {
    scene_.Update(world, camera);
    const std::span<uint8_t> colours = grey_ ? std::span(colours_) : planes;
    switch (output_) {
      case PainterOutput::kColours:
        renderer_->Draw(scene_.scene(), width_, height_, colours);
        break;
      case PainterOutput::kSegments:
        DrawSegments(colours);
        break;
      case PainterOutput::kDepths:
        DrawDepths(colours);
        break;
    }
    if (grey_) GreyOfPlanes(colours_, planes);
  }

  void SetOutput(PainterOutput output) override { output_ = output; }

 private:
  size_t pixels() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }

  void DrawSegments(std::span<uint8_t> planes) {
    std::vector<int32_t> numbers(pixels());
    renderer_->DrawNumbers(scene_.scene(), width_, height_, numbers);
    for (size_t i = 0; i < pixels(); ++i) {
      // Neighbouring numbers get very different colours.
      const uint32_t mixed = static_cast<uint32_t>(numbers[i] + 1) * 2654435761U;
      for (size_t c = 0; c < 3; ++c) {
        planes[c * pixels() + i] =
            numbers[i] < 0 ? uint8_t{0} : static_cast<uint8_t>(64 + (mixed >> (8 * c + 4)) % 192);
      }
    }
  }

  void DrawDepths(std::span<uint8_t> planes) {
    std::vector<float> depths(pixels());
    renderer_->DrawDepth(scene_.scene(), width_, height_, depths);
    const float least = std::ranges::min(depths);
    for (size_t i = 0; i < pixels(); ++i) {
      const float grey = std::isinf(depths[i]) ? 0 : 255 * least / depths[i];
      for (size_t c = 0; c < 3; ++c) planes[c * pixels() + i] = static_cast<uint8_t>(grey);
    }
  }

  int width_, height_;
  bool grey_;
  PainterOutput output_ = PainterOutput::kColours;
  std::vector<uint8_t> colours_;  // (3, H, W); empty unless the observation is grey
  AbstractScene scene_;
  std::optional<native::Renderer> renderer_;
};

}  // namespace

std::unique_ptr<Painter> MakeNativePainter(const ObservationConfig& observation) {
  return std::make_unique<NativePainter>(observation);
}

}  // namespace shoal::worlds

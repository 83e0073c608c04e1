// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/render_context.h"

#include "actor/worlds/engine_messages.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

std::unique_ptr<Painter> PainterOf(const ObservationConfig& observation) {
  const std::string& quality = observation.quality;
  if (quality == "native") return MakeNativePainter(observation);
  if (quality == "fast" || quality == "reference") return MakeOpenGlPainter(observation);
  throw UsageError("observation.quality is '{}'; expected fast, native or reference", quality);
}

}  // namespace

void Painter::SetOutput(PainterOutput output) {
  if (output == PainterOutput::kColours) return;
  throw UsageError("segments and depths are drawn in quality native alone");
}

RenderContext::RenderContext(const ObservationConfig& observation)
    : width_(observation.width), height_(observation.height), grey_(observation.grey) {
  CHECK(width_ > 0 && height_ > 0) << width_ << " x " << height_;
  InstallEngineCallbacks();
  painter_ = PainterOf(observation);
}

RenderContext::~RenderContext() = default;

void RenderContext::Attach(World* world) {
  if (!fingerprint_.empty()) {
    if (world->fingerprint() != fingerprint_) {
      throw RuntimeError("a render context draws one model: it has {}, an environment brings {}",
                         fingerprint_, world->fingerprint());
    }
    return;
  }
  CHECK(!world->textures_released()) << "a model without textures";
  painter_->TakeModel(world);
  fingerprint_ = world->fingerprint();
}

void RenderContext::Render(World* world, std::span<const CameraView> cameras,
                           std::span<uint8_t> frame) {
  CHECK(world->fingerprint() == fingerprint_) << "render before attach";
  const size_t bytes = static_cast<size_t>(channels_per_camera()) * static_cast<size_t>(height_) *
                       static_cast<size_t>(width_);
  CHECK(frame.size() == cameras.size() * bytes) << frame.size() << " bytes for " << cameras.size();
  for (size_t i = 0; i < cameras.size(); ++i) {
    painter_->Draw(world, cameras[i], frame.subspan(i * bytes, bytes));
  }
}

std::shared_ptr<RenderContext> MakeRenderContext(const ObservationConfig& observation) {
  return std::make_shared<RenderContext>(observation);
}

}  // namespace shoal::worlds

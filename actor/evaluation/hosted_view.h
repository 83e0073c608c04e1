// SPDX-License-Identifier: Apache-2.0
// The larger view of a user's environment. Shows the picture of the environment's `render`, scaled
// to fit into the view; black bars fill the rest.
#pragma once

#include <optional>
#include <vector>

#include "actor/evaluation/episode_view.h"
#include "actor/hosted/image_resize.h"
#include "actor/hosted/raw_environment.h"

namespace shoal::actor {

class HostedView final : public EpisodeView {
 public:
  // Borrows the policy's environment. `height` and `width`: size of the view.
  HostedView(hosted::RawEnvironment& environment, int height, int width)
      : environment_(environment), height_(height), width_(width) {}

  int height() const override { return height_; }
  int width() const override { return width_; }
  uint32_t step_microseconds() const override { return 0; }
  // Begin and Step throw Error if a picture has another size than the first picture.
  void Begin(uint64_t stream_key, std::span<uint8_t> picture) override;
  void Step(std::span<const float> action, float reward, std::span<uint8_t> picture) override;

 private:
  // Scales pictures of one size to the view.
  struct Fit {
    int from_height, from_width, height, width;
    hosted::ImageResize resize;
    std::vector<uint8_t> planes;  // (3, height, width)
  };

  void MakeFit(const hosted::RawPicture& drawn);
  void Draw(std::span<uint8_t> picture);

  hosted::RawEnvironment& environment_;
  const int height_, width_;
  std::optional<Fit> fit_;  // set when the first picture is drawn
};

}  // namespace shoal::actor

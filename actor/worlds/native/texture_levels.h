// SPDX-License-Identifier: Apache-2.0
// A model's textures with their mip levels.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "actor/worlds/native/frame_job.h"

namespace shoal::worlds::native {

// Owns the texels that view() points to; movable, not copyable.
class TextureLevels {
 public:
  // `rgb`: rows of (width, height) texels. If `cube`: six faces of width x width, one after
  // another, or one face that is used for all six. CHECK on sizes.
  TextureLevels(std::span<const uint8_t> rgb, int width, int height, bool cube);
  TextureLevels(TextureLevels&&) = default;
  TextureLevels& operator=(TextureLevels&&) = default;

  const Texture& view() const { return view_; }

 private:
  void AddLevel(std::span<const int32_t> texels, int width, int height);

  std::vector<std::vector<TexelPair>> texels_;
  Texture view_{};
};

}  // namespace shoal::worlds::native

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/texture_levels.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace shoal::worlds::native {
namespace {

constexpr int kFaces = 6;

std::vector<int32_t> Packed(std::span<const uint8_t> rgb) {
  std::vector<int32_t> texels(rgb.size() / 3);
  for (size_t i = 0; i < texels.size(); ++i) {
    texels[i] = rgb[3 * i] | rgb[3 * i + 1] << 8 | rgb[3 * i + 2] << 16;
  }
  return texels;
}

struct Neighbours {
  int first, second;
  float fraction;
};

// Texel `i` of a side of `to` texels is interpolated between the two of `from` texels whose centres
// surround it.
Neighbours NeighboursOf(int i, int to, int from) {
  const float at =
      (static_cast<float>(i) + 0.5f) * static_cast<float>(from) / static_cast<float>(to) - 0.5f;
  const int first = std::clamp(static_cast<int>(at), 0, from - 1);
  return {first, std::min(first + 1, from - 1),
          std::clamp(at - static_cast<float>(first), 0.0f, 1.0f)};
}

// Halves one face by linear interpolation, as OpenGL's mipmap generation does.
void Halve(std::span<const int32_t> from, int width, int height, int half_width, int half_height,
           int32_t* to) {
  for (int y = 0; y < half_height; ++y) {
    const Neighbours row = NeighboursOf(y, half_height, height);
    for (int x = 0; x < half_width; ++x) {
      const Neighbours column = NeighboursOf(x, half_width, width);
      int32_t mixed = 0;
      for (int shift = 0; shift < 24; shift += 8) {
        const auto channel = [&](int r, int c) {
          const size_t at = static_cast<size_t>(r) * static_cast<size_t>(width);
          return static_cast<float>(from[at + static_cast<size_t>(c)] >> shift & 255);
        };
        const auto mix = [&](int r) {
          const float first = channel(r, column.first);
          return first + column.fraction * (channel(r, column.second) - first);
        };
        const float upper = mix(row.first);
        const float value = upper + row.fraction * (mix(row.second) - upper);
        // Values are not negative, and all CPUs must round alike.
        // NOLINTNEXTLINE(bugprone-incorrect-roundings)
        mixed |= static_cast<int32_t>(value + 0.5f) << shift;
      }
      *to++ = mixed;
    }
  }
}

}  // namespace

TextureLevels::TextureLevels(std::span<const uint8_t> rgb, int width, int height, bool cube) {
  CHECK(width > 0 && height > 0);
  const auto face_texels = static_cast<size_t>(width) * static_cast<size_t>(cube ? width : height);
  const bool one_for_all = cube && width == height;
  CHECK(rgb.size() == 3 * face_texels * (cube && !one_for_all ? kFaces : 1))
      << rgb.size() << " bytes for " << width << " x " << height;
  view_.cube = cube;
  std::vector<int32_t> texels = Packed(rgb);
  if (one_for_all) {
    texels.reserve(kFaces * face_texels);
    while (texels.size() < kFaces * face_texels) {
      texels.insert(texels.end(), texels.begin(), texels.begin() + static_cast<long>(face_texels));
    }
  }
  if (cube) height = width;
  AddLevel(texels, width, height);
  while ((width > 1 || height > 1) && view_.levels < kMostLevels) {
    const int half_width = std::max(width / 2, 1), half_height = std::max(height / 2, 1);
    const size_t from = static_cast<size_t>(width) * static_cast<size_t>(height);
    const size_t to = static_cast<size_t>(half_width) * static_cast<size_t>(half_height);
    const size_t faces = cube ? kFaces : 1;
    std::vector<int32_t> halved(faces * to);
    for (size_t face = 0; face < faces; ++face) {
      Halve(std::span(texels).subspan(face * from, from), width, height, half_width, half_height,
            halved.data() + face * to);
    }
    width = half_width;
    height = half_height;
    AddLevel(halved, width, height);
    texels = std::move(halved);
  }
}

void TextureLevels::AddLevel(std::span<const int32_t> texels, int width, int height) {
  const auto columns = static_cast<size_t>(width), rows = static_cast<size_t>(height);
  std::vector<TexelPair> framed;
  framed.reserve(texels.size() / (rows * columns) * (rows + 1) * (columns + 2));
  std::vector<int32_t> upper(columns + 2), lower(columns + 2);  // rows of a framed face
  for (size_t face = 0; face < texels.size(); face += rows * columns) {
    const auto fill = [&](size_t y, std::vector<int32_t>* to) {
      const std::span<const int32_t> row = texels.subspan(face + y * columns, columns);
      to->front() = view_.cube ? row.front() : row.back();
      std::copy(row.begin(), row.end(), to->begin() + 1);
      to->back() = view_.cube ? row.back() : row.front();
    };
    fill(view_.cube ? 0 : rows - 1, &upper);
    for (size_t y = 0; y <= rows; ++y) {
      fill(y < rows ? y : view_.cube ? rows - 1 : 0, &lower);
      for (size_t x = 0; x < columns + 2; ++x) framed.push_back({upper[x], lower[x]});
      upper.swap(lower);
    }
  }
  texels_.push_back(std::move(framed));
  view_.level[view_.levels] = texels_.back().data();
  view_.width[view_.levels] = width;
  view_.height[view_.levels] = height;
  ++view_.levels;
}

}  // namespace shoal::worlds::native

// SPDX-License-Identifier: Apache-2.0
// Draws one picture of a film: the policy's input, the larger view, and texts that describe them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/spec/observation_spec.h"
#include "launch/tools/film/layout.h"

namespace shoal::launch {

struct FilmText {
  std::string title, subtitle;    // names of the run and of the policy
  uint32_t episode = 0;           // from 1
  uint32_t episodes = 0;          // number of episodes shown
  uint32_t step = 0;              // 0 = reset
  std::optional<float> reward{};  // of the step; empty at a reset
  double episode_return = 0;      // so far
  bool success = false;
};

// Owns the picture; the next Draw overwrites it. One thread.
class FilmPicture {
 public:
  // Throws Error if there is no font.
  explicit FilmPicture(const ObservationSpec& spec);
  ~FilmPicture();

  const FilmLayout& layout() const { return layout_; }

  // `input`: (I, H, W) u8, the policy's input; empty without pixels. I: channels of K frames and of
  // the goal picture, if there is one. Draw shows the newest frame and the goal picture. `view`:
  // (kFilmView, kFilmView, 3) u8. CHECK on other sizes.
  void Draw(const FilmText& text, std::span<const uint8_t> input, std::span<const uint8_t> view);

  // Rows of 4 bytes per pixel: B, G, R and an unused byte.
  std::span<const uint8_t> pixels() const;
  int stride() const;  // bytes from a row to the next

 private:
  struct Canvas;  // cairo's surface

  // Fills a box with the colours that colour_at(row, column) returns; row and column begin at 0.
  template <class ColourAt>
  void Fill(const Box& box, const ColourAt& colour_at);
  // Draws one camera's picture of `frame` (C, H, W).
  void DrawCamera(const Box& box, size_t camera, std::span<const uint8_t> frame);
  void DrawView(std::span<const uint8_t> view);
  void DrawWords(const FilmText& text);

  const ObservationSpec spec_;
  const FilmLayout layout_;
  std::unique_ptr<Canvas> canvas_;
};

}  // namespace shoal::launch

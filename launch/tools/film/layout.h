// SPDX-License-Identifier: Apache-2.0
// Layout of a film's picture, in pixels from the top left:
//
//   +----------------------------------------+
//   | title                                  |
//   | caption    caption                     |
//   | camera 1   larger view                 |
//   | caption                                |
//   | camera 2                               |
//   | episode   step   reward   return   ... |
//   +----------------------------------------+
#pragma once

#include <vector>

namespace shoal::launch {

struct Box {
  int x = 0, y = 0, width = 0, height = 0;
};

// Height and width of the larger view.
inline constexpr int kFilmView = 560;
// Height of the caption above a picture.
inline constexpr int kCaptionHeight = 24;

struct FilmLayout {
  int width = 0, height = 0;  // of the film; even, because H.264 halves the colours' resolution
  Box title, status;
  // The policy's pictures, scaled: its cameras in the order of the spec, then the cameras' goal
  // pictures.
  std::vector<Box> cameras;
  Box view;
};

// Layout for `cameras` pictures of `height` x `width` each; `cameras` is 0 for a policy without
// pixels. All pictures are enlarged by the same whole number, the largest with which the pictures
// fit next to the view. If the pictures are too large, all are reduced by the same whole number.
FilmLayout MakeFilmLayout(int cameras, int height, int width);

}  // namespace shoal::launch

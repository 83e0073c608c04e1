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
// Above a picture, for its caption.
inline constexpr int kCaptionHeight = 24;

struct FilmLayout {
  int width = 0, height = 0;  // of the film, even: H.264 halves the resolution of its colours
  Box title, status;
  // The policy's pictures, enlarged: its cameras in the order of the spec, then their goals.
  std::vector<Box> cameras;
  Box view;
};

// `cameras` pictures of `height` x `width` each; none for a policy without pixels. All are enlarged
// by the same whole number, the largest for which they fit beside the view, or, where they are too
// large for that, made smaller by one.
FilmLayout MakeFilmLayout(int cameras, int height, int width);

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/layout.h"

#include <algorithm>

namespace shoal::launch {
namespace {

constexpr int kMargin = 16, kTitleHeight = 56, kStatusHeight = 64;
constexpr int kMostCameraWidth = kFilmView;  // of all columns together

// The cameras in rows and columns; sizes in pixels.
struct Grid {
  int columns = 1, rows = 1;
  int height = 0, width = 0;  // of one picture as shown
};

// `size` enlarged or reduced by a whole number; at least one pixel.
int Resized(int size, int factor, int divisor) { return std::max(1, size * factor / divisor); }

Grid GridOf(int cameras, int columns, int height, int width) {
  const int rows = (cameras + columns - 1) / columns;
  const int free_height = std::max(1, (kFilmView + kCaptionHeight) / rows - kCaptionHeight);
  const int free_width = std::max(1, (kMostCameraWidth - (columns - 1) * kMargin) / columns);
  const int factor = std::max(1, std::min(free_height / height, free_width / width));
  const int divisor = std::max(
      {1, (height + free_height - 1) / free_height, (width + free_width - 1) / free_width});
  // Either the factor or the divisor is 1.
  return {columns, rows, Resized(height, factor, divisor), Resized(width, factor, divisor)};
}

Grid BestGrid(int cameras, int height, int width) {
  Grid best = GridOf(cameras, 1, height, width);
  for (int columns = 2; columns <= cameras; ++columns) {
    const Grid grid = GridOf(cameras, columns, height, width);
    if (grid.height > best.height) best = grid;
  }
  return best;
}

int Even(int size) { return size + size % 2; }

}  // namespace

FilmLayout MakeFilmLayout(int cameras, int height, int width) {
  FilmLayout layout;
  const int top = kTitleHeight + kCaptionHeight;
  int view_x = kMargin;
  if (cameras > 0) {
    const Grid grid = BestGrid(cameras, height, width);
    // The bottom of the last row is the bottom of the view.
    const int pitch = grid.rows == 1 ? 0 : (kFilmView - grid.height) / (grid.rows - 1);
    for (int i = 0; i < cameras; ++i) {
      const int column = i % grid.columns, row = i / grid.columns;
      layout.cameras.push_back(
          {kMargin + column * (grid.width + kMargin), top + row * pitch, grid.width, grid.height});
    }
    view_x += grid.columns * (grid.width + kMargin);
  }
  layout.view = {view_x, top, kFilmView, kFilmView};
  layout.width = Even(view_x + kFilmView + kMargin);
  layout.height = Even(top + kFilmView + kStatusHeight);
  layout.title = {kMargin, 0, layout.width - 2 * kMargin, kTitleHeight};
  layout.status = {kMargin, top + kFilmView, layout.width - 2 * kMargin, kStatusHeight};
  return layout;
}

}  // namespace shoal::launch

// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/plane_grids.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

namespace shoal::worlds::native {
namespace {

constexpr int kMostCells = mjMAXPLANEGRID;

// One axis of a grid: cells of equal width, and one cell of width `pad` at either end.
struct Division {
  int cells;
  double start, step, pad;  // start: where the second cell begins
};

Division DivideFinite(double half, double spacing) {
  const double limited = std::max(spacing, half / (kMostCells - 2));
  int cells = static_cast<int>(std::floor(half / std::max(mjMINVAL, limited)));
  cells -= cells % 2;
  const double pad = half - cells * limited;
  return {cells + 2, -half + pad, 2 * limited, pad};
}

// The grid reaches beyond the far plane. The engine moves it with the camera.
Division DivideEndless(const mjModel& model, int geom, int axis) {
  const double far = double{model.vis.map.zfar} * model.stat.extent;
  const int material = model.geom_matid[geom];
  double repeat = 2.1 * far / (kMostCells - 2);
  if (material >= 0 && model.mat_texrepeat[2 * material + axis] > 0) {
    repeat = 2 / double{model.mat_texrepeat[2 * material + axis]};
  }
  const double step = (2.1 * far + 2 * repeat) / kMostCells;
  return {kMostCells, step * (1 - kMostCells / 2), step, step};
}

std::vector<float> Vertices(const Division& d) {
  std::vector<float> at{static_cast<float>(d.start - d.pad)};
  for (int i = 0; i + 1 < d.cells; ++i) at.push_back(static_cast<float>(d.start + i * d.step));
  at.push_back(static_cast<float>(d.start + (d.cells - 2) * d.step + d.pad));
  return at;
}

}  // namespace

PlaneGrids::PlaneGrids(const mjModel& model) {
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_type[i] != mjGEOM_PLANE) continue;
    auto grid = std::make_unique<Grid>();
    PlaneGrid& view = grid->view;
    std::vector<float>* vertices[2] = {&grid->x, &grid->y};
    for (int axis = 0; axis < 2; ++axis) {
      const mjtNum* size = model.geom_size + 3 * i;
      const Division d =
          size[axis] > 0 ? DivideFinite(size[axis], size[2]) : DivideEndless(model, i, axis);
      view.cells[axis] = d.cells;
      view.start[axis] = static_cast<float>(d.start);
      view.step[axis] = static_cast<float>(d.step);
      view.inverse_step[axis] = static_cast<float>(1 / d.step);
      view.pad[axis] = static_cast<float>(d.pad);
      view.inverse_pad[axis] = d.pad > 0 ? static_cast<float>(1 / d.pad) : 0;
      *vertices[axis] = Vertices(d);
    }
    const size_t stride = (grid->x.size() + kTilePixels - 1) / kTilePixels * kTilePixels;
    grid->x.resize(stride, grid->x.back());
    const size_t rows = grid->y.size();
    grid->light.resize(3 * rows * stride);
    grid->stamps.resize(rows * stride / kTilePixels);
    view.stride = static_cast<int>(stride);
    view.x = grid->x.data();
    view.y = grid->y.data();
    for (size_t c = 0; c < 3; ++c) view.light[c] = grid->light.data() + c * rows * stride;
    view.stamps = grid->stamps.data();
    grids_.push_back(std::move(grid));
  }
}

}  // namespace shoal::worlds::native

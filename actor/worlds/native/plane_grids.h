// SPDX-License-Identifier: Apache-2.0
// The grids into which the engine divides planes. The engine computes light at the vertices of a
// grid and interpolates between the vertices; the interpolation is visible if cells are wide.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "actor/worlds/native/frame_job.h"

struct mjModel_;

namespace shoal::worlds::native {

// The grids of a model's planes, in the order of its plane geoms
// (mjvGeom::dataid).
class PlaneGrids {
 public:
  explicit PlaneGrids(const mjModel_& model);

  int size() const { return static_cast<int>(grids_.size()); }
  PlaneGrid* grid(int plane) { return &grids_[static_cast<size_t>(plane)]->view; }

 private:
  struct Grid {
    PlaneGrid view{};
    std::vector<float> x, y;
    std::vector<LightPair> light;
    std::vector<uint32_t> stamps;
  };

  std::vector<std::unique_ptr<Grid>> grids_;
};

}  // namespace shoal::worlds::native

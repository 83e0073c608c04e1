// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/plane_grids.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include "tests/actor/worlds/native/scene_by_hand.h"

namespace shoal::worlds::native {
namespace {

class PlaneGridsTest : public testing::Test {
 protected:
  PlaneGridsTest() {
    model_.ngeom = 1;
    model_.geom_type = &type_;
    model_.geom_size = size_;
    model_.geom_matid = &material_;
    model_.vis.map.zfar = 50;
    model_.stat.extent = 2;
  }

  mjModel model_ = EmptyModel();
  int type_ = mjGEOM_PLANE, material_ = -1;
  mjtNum size_[3] = {1, 0.5, 0.3};
};

// Half size 1 and spacing 0.3 make two cells of 0.6 and 0.4 of padding on either side.
TEST_F(PlaneGridsTest, CellsAreEvenAndPaddedAtTheEnds) {
  PlaneGrids grids(model_);
  ASSERT_EQ(grids.size(), 1);
  const PlaneGrid& grid = *grids.grid(0);
  EXPECT_EQ(grid.cells[0], 4);
  const float x[] = {-1, -0.6f, 0, 0.6f, 1};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(grid.x[i], x[i], 1e-6) << i;
  // A half size of 0.5 holds one spacing, made even: none.
  EXPECT_EQ(grid.cells[1], 2);
  const float y[] = {-0.5f, 0, 0.5f};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(grid.y[i], y[i], 1e-6) << i;
}

TEST_F(PlaneGridsTest, AnEndlessPlaneReachesBeyondTheFarPlane) {
  size_[0] = 0;
  PlaneGrids grids(model_);
  const PlaneGrid& grid = *grids.grid(0);
  EXPECT_EQ(grid.cells[0], mjMAXPLANEGRID);
  EXPECT_LT(grid.x[0], -100);  // zfar * extent
  EXPECT_GT(grid.x[mjMAXPLANEGRID], 100);
  EXPECT_NEAR(grid.x[mjMAXPLANEGRID / 2], 0, 1e-5);
}

TEST_F(PlaneGridsTest, OtherGeomsHaveNone) {
  type_ = mjGEOM_BOX;
  EXPECT_EQ(PlaneGrids(model_).size(), 0);
}

}  // namespace
}  // namespace shoal::worlds::native

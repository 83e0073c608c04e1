// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/columns.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

namespace shoal::learner {
namespace {

using testing::ElementsAre;

const std::vector<float> kLeft{1, 2, 3, 4};                       // (2, 2)
const std::vector<float> kRight{10, 11, 12, 13, 20, 21, 22, 23};  // (2, 4)

TEST(JoinColumns, PutsSomeColumnsBesideAllOfTheOthers) {
  const ObservationSpec::Range ranges[] = {{3, 1}, {0, 2}};
  std::vector<float> joined(10, NAN);
  JoinColumns(2, kLeft, kRight, ranges, joined);
  EXPECT_THAT(joined, ElementsAre(1, 2, 13, 10, 11, 3, 4, 23, 20, 21));
}

TEST(JoinColumns, RefusesAnArrayOfAnotherWidth) {
  const ObservationSpec::Range ranges[] = {{0, 1}};
  std::vector<float> joined(10);
  EXPECT_DEATH(JoinColumns(2, kLeft, kRight, ranges, joined), "10 numbers in 2 rows");
}

TEST(SplitColumns, DividesEveryRow) {
  std::vector<float> left(2, NAN), right(6, NAN);
  SplitColumns(2, kRight, left, right);
  EXPECT_THAT(left, ElementsAre(10, 20));
  EXPECT_THAT(right, ElementsAre(11, 12, 13, 21, 22, 23));
}

TEST(GatherLabels, AreColumnsAndDifferencesInTheirUnit) {
  const LabelColumns columns[] = {{.number = {false, 2}, .minus = {}},
                                  {.number = {false, 1}, .minus = {{true, 1}}}};
  std::vector<float> labels(4, NAN);
  GatherLabels(2, kLeft, kRight, columns, 0.5f, labels);
  EXPECT_THAT(labels, ElementsAre(24, 18, 44, 34));
}

}  // namespace
}  // namespace shoal::learner

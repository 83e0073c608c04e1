// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_export.h"

#include <gmock/gmock.h>

#include <limits>

#include "tests/launch/tools/export/random_policy.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(OnnxExport, SaysHowWellEachSetAgrees) {
  const policy::CheckpointPolicy policy = RandomPolicy({""});
  const ObservationSpec& spec = policy.description.spec;
  const OnnxExport exported =
      ExportOnnx(policy, {RandomObservations(spec, {}, 3, 1), RandomObservations(spec, {}, 20, 2)});
  EXPECT_EQ(exported.agreements.at(0).observations, 3);
  EXPECT_EQ(exported.agreements.at(1).observations, 20);
  EXPECT_LT(exported.agreements.at(1).largest_difference, kMostDifference);
  EXPECT_EQ(ReadOnnx(exported.bytes, "").metadata.at("task"), "test");
}

TEST(OnnxExport, ADifferenceIsRefusedWithItsSize) {
  EXPECT_EQ(ErrorMessage([] { CheckAgreement({.observations = 8, .largest_difference = 9e-5f}); }),
            "");
  EXPECT_THAT(
      ErrorMessage(1, [] { CheckAgreement({.observations = 8, .largest_difference = 3e-4f}); }),
      AllOf(HasSubstr("3.0e-04 on 8 observations"), HasSubstr("at most 1e-04")));
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_THAT(
      ErrorMessage(1, [&] { CheckAgreement({.observations = 8, .largest_difference = infinite}); }),
      HasSubstr("inf"));
}

}  // namespace
}  // namespace shoal::launch

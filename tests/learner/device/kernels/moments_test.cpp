// SPDX-License-Identifier: Apache-2.0
// Compares the kernels of moments with the operations of the CPU.
#include "learner/device/kernels/moments.h"

#include "common/nn/vector_scale.h"
#include "learner/engine/moments.h"
#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

class MomentKernels : public KernelTest {};

TEST_F(MomentKernels, VectorsAreStandardisedAndMomentsAdded) {
  constexpr int kRows = 301, kWidth = 5;
  std::vector<double> moments(MomentsSize(kWidth), 0.0);
  double* own = In(moments);
  Flags* flags = In(std::vector<Flags>{{1, 1, 0, 0}});
  for (int i = 0; i < 3; ++i) {
    const std::vector<float> vectors = Random(kRows * kWidth, -0.1, 3 * i + 0.2);
    learner::AddToMoments(vectors, moments);
    Run(AddToMoments{.rows = kRows,
                     .width = kWidth,
                     .vectors = In(vectors),
                     .moments = own,
                     .flags = flags,
                     .finished = Counters(1)});
    for (size_t j = 0; j < moments.size(); ++j) {
      EXPECT_NEAR(own[j], moments[j], 1e-12 * (1 + std::abs(moments[j])));
    }
    const std::vector<float> x = Random(kRows * kWidth, -20, 20);
    std::vector<float> expected(x.size());
    nn::VectorScale(MeanOf(moments), VarianceOf(moments, 0.01f)).Apply(x.data(), expected);
    float* y = Out(x.size());
    Run(Standardise{.rows = kRows,
                    .width = kWidth,
                    .x = In(x),
                    .moments = own,
                    .variance_floor = 0.01f,
                    .y = y});
    ExpectClose(y, expected, 1e-6);
  }
  flags->finite = 0;
  const std::vector<double> before(own, own + moments.size());
  Run(AddToMoments{.rows = kRows,
                   .width = kWidth,
                   .vectors = In(Random(kRows * kWidth)),
                   .moments = own,
                   .flags = flags,
                   .finished = Counters(1)});
  EXPECT_EQ(std::vector<double>(own, own + moments.size()), before);
}

TEST_F(MomentKernels, WithoutVectorsMomentsStandardiseToTheVectorItself) {
  const std::vector<float> x = Random(4);
  float* y = Out(4);
  Run(Standardise{
      .rows = 2, .width = 2, .x = In(x), .moments = In(std::vector<double>(5)), .y = y});
  ExpectClose(y, x, 1e-6);
}

}  // namespace
}  // namespace shoal::learner::kernels

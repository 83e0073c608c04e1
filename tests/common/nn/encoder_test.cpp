// SPDX-License-Identifier: Apache-2.0
// Compares encoders whose layers have several readers (skips and pools together) with references in
// double precision.
#include "common/nn/encoder.h"

#include <cmath>

#include "tests/common/nn/layer_fixture.h"
#include "tests/common/nn/reference_network.h"
#include "tests/common/nn/residual_plan.h"

namespace shoal::nn {
namespace {

using reference::Values;

constexpr int kEncoded = 3;

class ResidualEncoderTest : public LayerTest {
 protected:
  void SetUp() override {
    LayerTest::SetUp();
    if (IsSkipped()) return;  // no primitives in this precision
    parameters_.Initialise(1);
    Random random(2);
    for (int64_t i = 0; i < parameters_.size(); ++i) {
      parameters_.values()[i] += float(0.1 * random.Normal());
    }
    for (uint8_t& pixel : frames_) pixel = uint8_t(random.Next());
    TensorMap tensors;
    parameters_.Export(&tensors);
    exact_ = reference::ToParameters(tensors);
    encoder_ = std::make_unique<Encoder>(Context(parameters_, kEncoded), plan_);
    encoder_->Refresh();
  }

  Values Exact(Statistics statistics) const {
    return reference::Features(plan_, exact_, kEncoded, frames_.data(), statistics);
  }

  const NetworkPlan plan_ = ResidualPlan();
  ParameterSet parameters_{plan_.Parameters(), ParameterSet::Use::kTraining};
  std::vector<uint8_t> frames_ = std::vector<uint8_t>(size_t{kEncoded} * 2 * 13 * 11);
  reference::Parameters exact_;
  std::unique_ptr<Encoder> encoder_;
};

TEST_P(ResidualEncoderTest, FeaturesAgreeWithTheReferenceByBatchAndRunningStatistics) {
  for (const Statistics statistics : {Statistics::kBatch, Statistics::kRunning}) {
    encoder_->Forward(frames_.data(), statistics);
    EXPECT_LT(RelativeError(ReadMemory(encoder_->features()), Exact(statistics)),
              Tolerance(GetParam()));
  }
}

TEST_P(ResidualEncoderTest, GradientsOfAllReadersOfAMapAreSummed) {
  encoder_->Forward(frames_.data(), Statistics::kBatch);
  const Values dfeatures = RandomValues(Exact(Statistics::kBatch).size(), 8);
  FillMemory(dfeatures, encoder_->features_gradient());
  encoder_->Backward();
  Values all, all_exact;
  for (auto& [name, values] : exact_) {
    if (name.ends_with(kRunningMean) || name.ends_with(kRunningVariance)) continue;
    const std::span<const float> gradient = GradientOf(parameters_, name);
    std::vector<float> some;
    Values exact;
    for (size_t i = 0; i < values.size(); i += 1 + values.size() / 12) {
      some.push_back(gradient[i]);
      exact.push_back(
          CentralDifference(&values[i], [&] { return Dot(dfeatures, Exact(Statistics::kBatch)); }));
    }
    if (GetParam() == Precision::kF32) {
      EXPECT_LT(RelativeError(some, exact), 5e-4) << name;
    }
    all.insert(all.end(), some.begin(), some.end());
    all_exact.insert(all_exact.end(), exact.begin(), exact.end());
  }
  // In bf16, ReLUs with inputs near 0 are on the other side than in double. Only the direction of
  // the whole gradient can be compared.
  EXPECT_GT(Dot(all, all_exact) / std::sqrt(Dot(all, all) * Dot(all_exact, all_exact)),
            GetParam() == Precision::kF32 ? 0.9999 : 0.95);
}

INSTANTIATE_PRECISIONS(ResidualEncoderTest);

}  // namespace
}  // namespace shoal::nn

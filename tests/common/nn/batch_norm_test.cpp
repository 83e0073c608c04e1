// SPDX-License-Identifier: Apache-2.0
#include "common/nn/batch_norm.h"

#include <gmock/gmock.h>

#include "common/nn/adam.h"
#include "tests/common/nn/layer_fixture.h"

namespace shoal::nn {
namespace {

using reference::Moments;
using reference::Values;

constexpr int kBatch = 3, kChannels = 5, kHeight = 4, kWidth = 7;
constexpr size_t kNumbers = size_t{kBatch} * kChannels * kHeight * kWidth;
constexpr double kCount = kBatch * kHeight * kWidth;  // n

class BatchNormTest : public LayerTest {
 protected:
  void SetUp() override {
    LayerTest::SetUp();
    x_ = RandomValues(kNumbers, 1);
    for (size_t k = 0; k < kNumbers; ++k) x_[k] = 3 * x_[k] + double(k % 5);
  }

  void Build(bool skip, Activation activation, bool training = true) {
    NetworkPlan plan({kChannels, kHeight, kWidth});
    plan.Add(NetworkPlan::Convolution{.name = "conv",
                                      .key = "k",
                                      .filters = kChannels,
                                      .kernel = 1,
                                      .stride = 1,
                                      .activation = activation,
                                      .bias = false,
                                      .batch_norm = "norm"});
    parameters_ = std::make_unique<ParameterSet>(
        plan.Parameters(), training ? ParameterSet::Use::kTraining : ParameterSet::Use::kInference);
    Randomise(parameters_.get(), 2, 1);
    for (float& value : Statistic("norm.running_var")) value = 1.5f + value;  // above 0
    source_ = Map();
    if (skip) skip_ = Map();
    norm_ = std::make_unique<BatchNorm>(Context(*parameters_, kBatch, training), plan.layers()[0],
                                        source_, skip_);
    norm_->Refresh();
    FillMemory(x_, source_.values);
    if (skip) FillMemory(added_, skip_.values);
  }

  static MapSource Map() {
    const dnnl::memory values =
        MakeMemory(dnnl::memory::desc({kBatch, kChannels, kHeight, kWidth}, ComputeType(GetParam()),
                                      dnnl::memory::format_tag::nchw));
    return {values, MakeMemory(values.get_desc())};
  }

  std::span<float> Statistic(const std::string& name) {
    return {parameters_->Find(name).value(), kChannels};
  }
  Values P(const std::string& name) {
    return ToDoubles({parameters_->Find(name).value(), kChannels});
  }

  Values Exact(const Moments& moments) {
    return reference::BatchNormForward(kBatch, x_, moments, P("norm.weight"), P("norm.bias"));
  }

  // Gradients of a pass of the batch whose output is read back, so that units at the edge of their
  // ReLU are on the same side.
  void CompareBackward(bool skip, bool relu) {
    Values dy = RandomValues(kNumbers, 4);
    FillMemory(dy, norm_->output_gradient());
    const std::vector<float> y = ReadMemory(norm_->output());
    norm_->Backward();
    for (size_t k = 0; k < kNumbers; ++k) {
      if (relu && y[k] <= 0) dy[k] = 0;
    }
    const auto exact = reference::BatchNormBackward(kBatch, x_, P("norm.weight"), dy);
    EXPECT_LT(RelativeError(GradientOf(*parameters_, "norm.weight"), exact.weight),
              Tolerance(GetParam()));
    EXPECT_LT(RelativeError(GradientOf(*parameters_, "norm.bias"), exact.bias),
              Tolerance(GetParam()));
    EXPECT_LT(RelativeError(ReadMemory(source_.gradient), exact.source), Tolerance(GetParam()));
    if (!skip) return;
    EXPECT_LT(RelativeError(ReadMemory(skip_.gradient), dy), Tolerance(GetParam()));
  }

  Values x_, added_ = RandomValues(kNumbers, 3);
  std::unique_ptr<ParameterSet> parameters_;
  MapSource source_, skip_;
  std::unique_ptr<BatchNorm> norm_;
};

TEST_P(BatchNormTest, NormalisesByTheBatchAndAgreesWithTheReference) {
  Build(/*skip=*/false, Activation::kNone);
  norm_->Forward(Statistics::kBatch);
  EXPECT_LT(RelativeError(ReadMemory(norm_->output()),
                          Exact(reference::BatchMoments(kBatch, x_, kChannels))),
            Tolerance(GetParam()));
  CompareBackward(/*skip=*/false, /*relu=*/false);
}

TEST_P(BatchNormTest, ASkipIsAddedBeforeTheReluAndGetsTheGradientBehindIt) {
  Build(/*skip=*/true, Activation::kRelu);
  norm_->Forward(Statistics::kBatch);
  const Values normalised = Exact(reference::BatchMoments(kBatch, x_, kChannels));
  EXPECT_LT(RelativeError(ReadMemory(norm_->output()),
                          reference::Relu(reference::Plus(normalised, added_))),
            Tolerance(GetParam()));
  CompareBackward(/*skip=*/true, /*relu=*/true);
}

TEST_P(BatchNormTest, ASkipMayBeAddedWithoutRelu) {
  Build(/*skip=*/true, Activation::kNone);
  norm_->Forward(Statistics::kBatch);
  const Values normalised = Exact(reference::BatchMoments(kBatch, x_, kChannels));
  EXPECT_LT(RelativeError(ReadMemory(norm_->output()), reference::Plus(normalised, added_)),
            Tolerance(GetParam()));
  CompareBackward(/*skip=*/true, /*relu=*/false);
}

TEST_P(BatchNormTest, ByRunningStatisticsABatchDoesNotMatter) {
  Build(/*skip=*/false, Activation::kRelu, /*training=*/false);
  norm_->Forward(Statistics::kRunning);
  const Moments running{P("norm.running_mean"), P("norm.running_var")};
  EXPECT_LT(RelativeError(ReadMemory(norm_->output()), reference::Relu(Exact(running))),
            Tolerance(GetParam()));
}

TEST_P(BatchNormTest, RunningStatisticsMoveByATenthOfTheUnbiasedOnesWithTheOptimisersStep) {
  Build(/*skip=*/false, Activation::kNone);
  const Values mean = P("norm.running_mean"), variance = P("norm.running_var");
  const Moments batch = reference::BatchMoments(kBatch, x_, kChannels);
  Adam adam({parameters_.get()}, {.rate = 1e-3});
  norm_->Forward(Statistics::kRunning);
  norm_->Forward(Statistics::kBatch);
  FillMemory(RandomValues(kNumbers, 4), norm_->output_gradient());
  norm_->Backward();
  EXPECT_EQ(P("norm.running_mean"), mean) << "a pass alone moves nothing";
  EXPECT_EQ(P("norm.running_var"), variance);

  adam.Step();
  Values next_mean, next_variance;
  for (size_t c = 0; c < kChannels; ++c) {
    next_mean.push_back(0.9 * mean[c] + 0.1 * batch.mean[c]);
    next_variance.push_back(0.9 * variance[c] + 0.1 * batch.variance[c] * kCount / (kCount - 1));
  }
  EXPECT_LT(RelativeError(Statistic("norm.running_mean"), next_mean), Tolerance(GetParam()));
  EXPECT_LT(RelativeError(Statistic("norm.running_var"), next_variance), Tolerance(GetParam()));

  adam.Undo();
  EXPECT_EQ(P("norm.running_mean"), mean);
  EXPECT_EQ(P("norm.running_var"), variance);
}

INSTANTIATE_PRECISIONS(BatchNormTest);

}  // namespace
}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
// Compares an encoder whose layers have several readers with references in double precision.
#include "learner/device/modules/device_encoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/base/random.h"
#include "common/nn/device_memory.h"
#include "common/nn/encoder_module.h"
#include "learner/device/device_engine.h"
#include "learner/device/host_device.h"
#include "tests/common/nn/gradient_check.h"
#include "tests/common/nn/reference_network.h"
#include "tests/common/nn/residual_plan.h"
#include "tests/learner/device/device_fixture.h"

namespace shoal::learner::device {
namespace {

using nn::reference::Values;

constexpr int kEncoded = 3;

class DeviceEncoderTest : public testing::Test {
 protected:
  DeviceEncoderTest() {
    nn::ParameterSet& set = module_.parameters();
    set.Initialise(random_.Next());
    for (int64_t i = 0; i < set.size(); ++i) set.values()[i] += float(0.1 * random_.Normal());
    for (uint8_t& pixel : frames_) pixel = uint8_t(random_.Next());
    nn::TensorMap tensors;
    set.Export(&tensors);
    exact_ = nn::reference::ToParameters(tensors);
  }
  void TearDown() override {
    if (HasFailure()) ADD_FAILURE() << "repeat with --gtest_random_seed=" << seed_;
  }

  Values Exact(nn::Statistics statistics) const {
    return nn::reference::Features(plan_, exact_, kEncoded, frames_.data(), statistics);
  }
  void Forward(nn::Statistics statistics) {
    module_.Forward(nn::DeviceArray(frames_.data(), int64_t(frames_.size())), statistics);
    device_.Finish();
  }
  // Calls body(number of the reference's order, number of the device's map).
  template <class Body>
  void ForFeatures(const Body& body) const {
    const DeviceFeatures& features = DeviceFeatures::Of(module_.features());
    const nn::MapShape& map = features.map();
    for (int i = 0; i < kEncoded * int(map.size()); ++i) {
      const int pixels = map.height * map.width, pixel = i % pixels;
      const int channel = i / pixels % map.channels, row = i / pixels / map.channels;
      body(size_t(i), (size_t(row) * pixels + pixel) * features.padded_channels() + channel);
    }
  }
  void ExpectFeatures(nn::Statistics statistics) {
    Forward(statistics);
    const auto* values = static_cast<const float*>(DeviceFeatures::Of(module_.features()).values());
    const Values expected = Exact(statistics);
    std::vector<float> features(expected.size());
    ForFeatures([&](size_t at, size_t of_map) { features[at] = values[of_map]; });
    EXPECT_LT(nn::RelativeError(features, expected), 2e-5);
  }
  // Gradients of all parameters, or their values, in the order of the host.
  std::vector<float> OnHost(const float* values, bool statistics) const {
    std::vector<float> host(size_t(module_.parameters().size()));
    DeviceParameters::Of(module_.parameters()).layout().ToHost(values, statistics, host.data());
    return host;
  }

  const int seed_ = testing::UnitTest::GetInstance()->random_seed();
  Random random_{uint64_t(seed_) + 1};
  const nn::NetworkPlan plan_ = nn::ResidualPlan();
  HostDevice device_{kPadding};
  DeviceEngine engine_{&device_, nn::Precision::kF32, kEncoded};
  nn::EncoderModule module_{plan_, nn::Module::Use::kTraining, engine_.modules()};
  std::vector<uint8_t> frames_ = std::vector<uint8_t>(size_t{kEncoded} * 2 * 13 * 11);
  nn::reference::Parameters exact_;
};

TEST_F(DeviceEncoderTest, FeaturesAreThoseOfTheReferenceByBatchAndRunningStatistics) {
  ExpectFeatures(nn::Statistics::kBatch);
  ExpectFeatures(nn::Statistics::kRunning);
}

TEST_F(DeviceEncoderTest, GradientsOfAllReadersOfAMapAreSummed) {
  Forward(nn::Statistics::kBatch);
  const Values dfeatures = nn::RandomValues(Exact(nn::Statistics::kBatch).size(), random_.Next());
  auto* gradient = static_cast<float*>(DeviceFeatures::Of(module_.features()).gradient());
  ForFeatures([&](size_t at, size_t of_map) { gradient[of_map] = float(dfeatures[at]); });
  module_.Backward();
  device_.Finish();
  const nn::ParameterSet& set = module_.parameters();
  const DeviceParameters& mirror = DeviceParameters::Of(set);
  const std::vector<float> gradients = OnHost(mirror.gradients(), /*statistics=*/false);
  Values some, expected;
  for (size_t spec = 0; spec < set.specs().size(); ++spec) {
    if (set.specs()[spec].statistic) continue;
    Values& values = exact_.at(set.specs()[spec].name);
    for (size_t i = 0; i < values.size(); i += 1 + values.size() / 12) {
      some.push_back(double(gradients[size_t(set.OffsetOf(spec)) + i]));
      expected.push_back(nn::CentralDifference(
          &values[i], [&] { return nn::Dot(dfeatures, Exact(nn::Statistics::kBatch)); }));
    }
  }
  // A ReLU with an input near 0 may be on the other side than in double.
  const double cosine =
      nn::Dot(some, expected) / std::sqrt(nn::Dot(some, some) * nn::Dot(expected, expected));
  EXPECT_GT(cosine, 0.9999);
  EXPECT_NEAR(nn::Dot(some, some), nn::Dot(expected, expected), 1e-2 * nn::Dot(expected, expected));
}

// Statistics wait for the optimiser's step.
TEST_F(DeviceEncoderTest, APassByTheBatchPreparesTheNextStatistics) {
  Forward(nn::Statistics::kBatch);
  const DeviceParameters& mirror = DeviceParameters::Of(module_.parameters());
  const ParameterLayout& layout = mirror.layout();
  std::vector<float> next(size_t(layout.size()));
  std::ranges::copy_n(mirror.next_statistics(), layout.size() - layout.trained_size(),
                      next.begin() + layout.trained_size());
  const std::vector<float> host = OnHost(next.data(), /*statistics=*/true);
  const std::vector<float> values = OnHost(mirror.values(), /*statistics=*/true);
  const nn::ParameterSet& set = module_.parameters();
  for (size_t spec = 0; spec < set.specs().size(); ++spec) {
    const auto& [name, shape, start, statistic] = set.specs()[spec];
    const Values& before = exact_.at(name);
    for (size_t c = 0; c < before.size(); ++c) {
      const size_t at = size_t(set.OffsetOf(spec)) + c;
      ASSERT_EQ(double(values[at]), before[c]) << name;
      if (statistic) {
        EXPECT_NE(double(host[at]), before[c]) << name;
      }
    }
  }
}

}  // namespace
}  // namespace shoal::learner::device

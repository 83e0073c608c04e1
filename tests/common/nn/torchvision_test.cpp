// SPDX-License-Identifier: Apache-2.0
// Compares resnet18 and alexnet with torchvision for equal weights and images.
// tests/comparison/torchvision_encoders.py made the recordings and describes the files.
#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <numeric>
#include <set>

#include "common/base/files.h"
#include "common/nn/adam.h"
#include "common/nn/encoder_module.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "common/nn/parallel.h"
#include "tests/common/nn/network_fixture.h"
#include "tests/support/paths.h"
#include "tests/support/shared_numbers.h"

namespace shoal::nn {
namespace {

constexpr int kImages = 4;
constexpr size_t kFeatures = 256, kOthers = 48;  // entries that are recorded at most
const std::string kPrefix = "encoder.";

struct EncoderCase {
  const char* kind;
  int channels, height, width;
};

void PrintTo(const EncoderCase& each, std::ostream* out) {
  *out << each.kind << " " << each.channels;
}

class TorchvisionTest : public testing::TestWithParam<EncoderCase> {
 protected:
  TorchvisionTest() : recorded_(Recording()), encoder_(Plan(), Module::Use::kTraining, context_) {
    for (const ParameterSpec& parameter : Plan().Parameters()) names_.push_back(parameter.name);
    for (const std::string& name : names_) SetWeights(name);
    encoder_.Refresh();
  }

  static TensorMap Recording() {
    const std::string file =
        std::string(GetParam().kind) + "_" + std::to_string(GetParam().channels) + ".safetensors";
    return ReadSafetensors(ReadFile(GoldenPath("torchvision/" + file)), file);
  }

  static NetworkPlan Plan() {
    NetworkConfig network;
    network.encoder = GetParam().kind;
    ObservationSpec spec;
    spec.cameras = {"front"};
    spec.channels = GetParam().channels;
    spec.height = GetParam().height;
    spec.width = GetParam().width;
    return PlanEncoder(network, spec);
  }

  static std::string Theirs(const std::string& name) { return name.substr(kPrefix.size()); }

  std::span<float> Values(const std::string& name) {
    const Parameter parameter = encoder_.parameters().Find(name);
    return {parameter.value(), Count(parameter)};
  }

  // Same as set_weights of the script.
  void SetWeights(const std::string& name) {
    const std::span<float> values = Values(name);
    const std::vector<int64_t> shape = encoder_.parameters().Find(name).shape();
    const bool convolution = shape.size() == 4;
    const double inputs = convolution ? double(shape[1] * shape[2] * shape[3]) : 1;
    FillSymmetric(Theirs(name), convolution ? std::sqrt(6 / inputs) : 1, values);
    if (convolution) return;
    for (float& u : values) {
      if (name.ends_with("bn1.bias")) {
        u = std::copysign(1 + 0.2f * std::abs(u), u);
      } else if (name.ends_with("bn2.bias")) {
        u = u < -0.5f ? -8 : 2;
      } else if (name.ends_with("downsample.1.bias")) {
        u = 1 + 0.2f * u;
      } else if (name.ends_with(".running_var")) {
        u = 1 + 0.3f * u;
      } else {
        u = name.ends_with(".weight") ? 0.3f * (1 + 0.3f * u) : 0.2f * u;
      }
    }
  }

  std::vector<float> Forward(const std::string& name, Statistics statistics) {
    const auto& [kind, channels, height, width] = GetParam();
    std::vector<uint8_t> images;
    for (const double u : SharedUniform(name, size_t(kImages) * channels * height * width)) {
      images.push_back(uint8_t(u * 256));
    }
    encoder_.Forward(HostArray(images), statistics);
    return ReadMemory(OnHost(encoder_.features()).values());
  }

  void Backward(const std::string& name, size_t features) {
    std::vector<float> coefficient(features);
    FillSymmetric(name, 1, coefficient);
    FillMemory(ToDoubles(coefficient), OnHost(encoder_.features()).gradient());
    encoder_.Backward();
  }

  // The recorded entries of `ours` and its norm, as shares of the largest entry and of the norm.
  void ExpectTheirs(const std::string& name, std::span<const float> ours, size_t most,
                    double tolerance) const {
    ASSERT_TRUE(recorded_.contains(name)) << name;
    const NamedTensor& tensor = recorded_.at(name);
    std::vector<float> theirs(tensor.data.size() / sizeof(float));
    std::memcpy(theirs.data(), tensor.data.data(), tensor.data.size());
    const double norm = theirs.back();
    theirs.pop_back();
    ASSERT_EQ(theirs.size(), std::min(most, ours.size())) << name;
    std::vector<float> picked;
    double squares = 0;
    for (size_t i = 0; i < theirs.size(); ++i)
      picked.push_back(ours[i * ours.size() / theirs.size()]);
    for (const float value : ours) squares += double(value) * value;
    EXPECT_GT(norm, 0) << name;
    EXPECT_LT(RelativeError(picked, ToDoubles(theirs)), tolerance) << name;
    EXPECT_NEAR(std::sqrt(squares) / norm, 1, tolerance) << name;
  }

  const TensorMap recorded_;
  const ThreadScope one_thread_{1};
  const ModuleContext context_{Precision::kF32, kImages, 1};
  EncoderModule encoder_;
  std::vector<std::string> names_;
};

TEST_P(TorchvisionTest, ParametersHaveTheirNamesBehindThePrefix) {
  std::set<std::string> ours, theirs;
  for (const std::string& name : names_) ours.insert("after." + Theirs(name));
  for (const auto& [name, tensor] : recorded_) {
    if (name.starts_with("after.")) theirs.insert(name);
  }
  EXPECT_EQ(ours, theirs);
}

TEST_P(TorchvisionTest, FeaturesGradientsStepsAndRunningStatisticsAreTheirs) {
  Adam adam({&encoder_.parameters()}, {.rate = 1e-3, .epsilon = 0.1});
  const std::vector<float> features = Forward("training.images", Statistics::kBatch);
  ExpectTheirs("training.features", features, kFeatures, 2e-5);
  Backward("coefficient", features.size());
  for (const std::string& name : names_) {
    if (encoder_.parameters().Find(name).gradient() == nullptr) continue;
    ExpectTheirs("gradient." + Theirs(name), GradientOf(encoder_.parameters(), name), kOthers,
                 1e-3);
  }
  adam.Step();
  encoder_.Refresh();
  for (const std::string& name : names_) {
    ExpectTheirs("after." + Theirs(name), Values(name), kOthers, 2e-5);
  }
  ExpectTheirs("evaluation.features", Forward("evaluation.images", Statistics::kRunning), kFeatures,
               2e-5);
}

INSTANTIATE_TEST_SUITE_P(
    Of, TorchvisionTest,
    testing::Values(EncoderCase{"resnet18", 1, 84, 84}, EncoderCase{"resnet18", 3, 70, 61},
                    EncoderCase{"resnet18", 4, 84, 84}, EncoderCase{"resnet18", 9, 84, 84},
                    EncoderCase{"alexnet", 1, 70, 255}, EncoderCase{"alexnet", 3, 84, 84},
                    EncoderCase{"alexnet", 4, 84, 84}, EncoderCase{"alexnet", 9, 97, 130}),
    [](const auto& each) {
      return std::string(each.param.kind) + std::to_string(each.param.channels);
    });

}  // namespace
}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
#include "common/nn/vector_scale.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/actor_critic_plan.h"

namespace shoal::nn {
namespace {

constexpr float kScaleEpsilon = 1e-8f;

std::vector<float> ReadVector(const TensorViews& tensors, const std::string& name, int size,
                              const std::string& source) {
  const TensorView* tensor = tensors.Find(name);
  if (tensor == nullptr) throw RuntimeError("{}: no tensor '{}'", source, name);
  if (tensor->dtype != "F32" || tensor->shape != std::vector<int64_t>{size}) {
    throw RuntimeError("{}: '{}' is not F32 of shape {}", source, name, size);
  }
  std::vector<float> values(static_cast<size_t>(size));
  std::memcpy(values.data(), tensor->data.data(), values.size() * sizeof(float));
  return values;
}

}  // namespace

VectorScale::VectorScale(std::span<const float> mean, std::span<const float> variance)
    : mean_(mean.begin(), mean.end()) {
  CHECK(mean.size() == variance.size() && !mean.empty());
  for (const float v : variance) factor_.push_back(1 / std::sqrt(v + kScaleEpsilon));
}

void VectorScale::Apply(const float* x, std::span<float> y) const {
  CHECK(y.size() % mean_.size() == 0) << y.size();
  for (size_t i = 0, j = 0; i < y.size(); ++i, j = j + 1 == mean_.size() ? 0 : j + 1) {
    y[i] = std::clamp((x[i] - mean_[j]) * factor_[j], -kLimit, kLimit);
  }
}

std::optional<VectorScale> ReadVectorScale(const TensorViews& tensors, int vector_size,
                                           const std::string& source) {
  if (!tensors.Find(kObservationMean) && !tensors.Find(kObservationVariance)) return {};
  const std::vector<float> mean = ReadVector(tensors, kObservationMean, vector_size, source);
  const std::vector<float> variance =
      ReadVector(tensors, kObservationVariance, vector_size, source);
  for (const float v : variance) {
    if (!(v >= 0)) throw RuntimeError("{}: '{}' holds {}", source, kObservationVariance, v);
  }
  return VectorScale(mean, variance);
}

}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
#include "common/policy/trained_policy.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/base/error.h"
#include "common/base/one_line.h"

namespace shoal::policy {
namespace {

// A batch is computed in parts whose sizes are powers of two up to this. One network is built for
// each size, so networks are few and small whatever the batches.
constexpr int kLargestPart = 64;

bool AllFinite(std::span<const float> values) {
  return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
}

// Names of the observed blocks, for an error.
std::string ObservedNames(const ObservationSpec& spec) {
  std::string names;
  for (const BlockSpec& block : spec.blocks) {
    if (block.observed) names += (names.empty() ? "" : ", ") + block.name;
  }
  return names.empty() ? "none" : names;
}

}  // namespace

TrainedPolicy::TrainedPolicy(const CheckpointPolicy& policy, nn::Precision precision)
    : description_(policy.description),
      policy_(description_.network, description_.spec, precision, kLargestPart) {
  policy_.Load(policy.tensors, kPolicyFile);
  // Builds the network of one observation in advance.
  const std::vector<uint8_t> frames(size_t(spec().InputBytes()));
  const std::vector<float> vector(size_t(spec().VectorSize()));
  policy_.Forward(1, frames.data(), vector.data());
  vectors_.reserve(vector.size());
}

TrainedPolicy::TrainedPolicy(const std::filesystem::path& checkpoint, nn::Precision precision)
    : TrainedPolicy(ReadCheckpointPolicy(checkpoint), precision) {}

void TrainedPolicy::CheckPixels(const Observations& observations) const {
  const int channels = spec().InputChannels();
  const size_t expected = size_t(observations.count) * size_t(spec().InputBytes());
  if (observations.pixels.size() == expected) return;
  throw UsageError("pixels: {} bytes, expected {} = {} x {} x {} x {}", observations.pixels.size(),
                   expected, observations.count, channels, spec().height, spec().width);
}

void TrainedPolicy::GatherVectors(const Observations& observations) {
  const auto count = size_t(observations.count);
  const auto row = size_t(spec().VectorSize());
  vectors_.resize(count * row);
  const auto given = [&](std::string_view name) {
    return std::ranges::count(observations.blocks, name, &ObservedBlock::name);
  };
  for (const auto& [name, values] : observations.blocks) {
    const auto range = spec().Observed(name);
    if (!range) {
      throw UsageError("block '{}' is not observed by this policy, expected {}",
                       Shortened(std::string(name), 60), ObservedNames(spec()));
    }
    if (given(name) > 1) throw UsageError("block '{}' is given twice", name);
    const auto size = size_t(range->size);
    if (values.size() != count * size) {
      throw UsageError("block '{}': {} numbers, expected {} = {} x {}", name, values.size(),
                       count * size, count, size);
    }
    if (!AllFinite(values)) {
      throw NonFiniteError("block '{}' holds a number that is not finite", name);
    }
    for (size_t n = 0; n < count; ++n) {
      std::ranges::copy(values.subspan(n * size, size),
                        vectors_.begin() + std::ptrdiff_t(n * row + size_t(range->first)));
    }
  }
  for (const BlockSpec& block : spec().blocks) {
    if (block.observed && given(block.name) == 0) {
      throw UsageError("block '{}' is missing: {} numbers for each observation", block.name,
                       block.size);
    }
  }
}

void TrainedPolicy::Act(const Observations& observations, std::span<float> actions) {
  const int count = observations.count;
  if (count <= 0) throw UsageError("{} observations, expected at least 1", count);
  const auto size = size_t(spec().action_size);
  if (actions.size() != size_t(count) * size) {
    throw UsageError("actions: room for {} numbers, expected {} = {} x {}", actions.size(),
                     size_t(count) * size, count, size);
  }
  if (spec().HasPixels()) CheckPixels(observations);
  GatherVectors(observations);
  const auto input_bytes = size_t(spec().InputBytes());
  const auto row = size_t(spec().VectorSize());
  for (int done = 0; done < count;) {
    const int part = std::min(int(std::bit_floor(unsigned(count - done))), kLargestPart);
    const auto first = size_t(done);
    const nn::PolicyOutput output = policy_.Forward(
        part, observations.pixels.data() + (spec().HasPixels() ? first * input_bytes : 0),
        vectors_.data() + first * row);
    nn::MeanActions(output, actions.subspan(first * size, size_t(part) * size));
    done += part;
  }
  if (!AllFinite(actions)) throw NonFiniteError("the policy's output is not finite");
}

}  // namespace shoal::policy

// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/observation_mapping.h"

#include <algorithm>
#include <cmath>

#include "actor/hosted/element_conversion.h"
#include "actor/worlds/episode_fault.h"
#include "common/base/check.h"
#include "common/base/log.h"

namespace shoal::hosted {
namespace {

using tasks::ArraySpace;
using worlds::EpisodeFault;
using worlds::FaultCause;

bool IsBounded(const ArraySpace& space) {
  const auto finite = [](double bound) { return std::isfinite(bound); };
  return std::ranges::any_of(space.low, finite) || std::ranges::any_of(space.high, finite);
}

// Frames are grey if each camera has one channel.
bool IsGrey(const ObservationSpec& spec) { return spec.channels == int(spec.cameras.size()); }

}  // namespace

ObservationMapping::ObservationMapping(const tasks::EnvironmentDescription& description,
                                       const ObservationSpec& spec)
    : id_(description.id), plane_(size_t(spec.height) * size_t(spec.width)) {
  const auto place = [&](const std::string& name) {
    const ArraySpace* space = description.Find(name);
    CHECK(space != nullptr) << name;
    return size_t(space - description.observation.data());
  };
  for (const std::string& name : spec.cameras) {
    const size_t array = place(name);
    images_.push_back({.array = array,
                       .resize = ImageResize(*ImageLayoutOf(description.observation[array]),
                                             IsGrey(spec), spec.height, spec.width)});
  }
  for (const BlockSpec& block : spec.blocks) {
    const size_t array = place(block.name);
    const ArraySpace& space = description.observation[array];
    blocks_.push_back({.array = array,
                       .first = size_t(spec.Recorded(block.name)->first),
                       .space = space,
                       .bounded = IsBounded(space)});
  }
}

void ObservationMapping::ReadVector(std::span<const void* const> arrays, int64_t steps,
                                    std::span<float> vector) {
  for (Block& block : blocks_) {
    const std::span<float> numbers = vector.subspan(block.first, size_t(block.space.size()));
    ConvertTo(block.space.type, arrays[block.array], numbers);
    CheckNumbers(numbers, steps, &block);
  }
}

void ObservationMapping::CheckNumbers(std::span<const float> numbers, int64_t steps,
                                      Block* block) const {
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i])) {
      throw EpisodeFault(
          FaultCause::kObservation,
          fmt::format("environment {}: number {} of '{}' is {} after {} steps: not a finite "
                      "float32",
                      id_, i, block->space.name, numbers[i], steps));
    }
    if (!block->bounded || block->warned) continue;
    const bool inside = numbers[i] >= float(block->space.Low(int(i))) &&
                        numbers[i] <= float(block->space.High(int(i)));
    if (!inside) WarnOutside(i, numbers[i], steps, block);
  }
}

// Only warns: many environments leave their bounds by a rounding error.
void ObservationMapping::WarnOutside(size_t element, float value, int64_t steps,
                                     Block* block) const {
  block->warned = true;
  const ArraySpace& space = block->space;
  log::Warning(
      "environment {}: number {} of '{}' is {} after {} steps, outside of its declared bounds "
      "[{}, {}]; such numbers are used as they are, and this is the only warning for '{}'",
      id_, element, space.name, value, steps, space.Low(int(element)), space.High(int(element)),
      space.name);
}

void ObservationMapping::ReadFrame(std::span<const void* const> arrays, std::span<uint8_t> frame) {
  size_t at = 0;
  for (Image& image : images_) {
    const size_t bytes = plane_ * size_t(image.resize.channels());
    image.resize.Apply(static_cast<const uint8_t*>(arrays[image.array]), frame.subspan(at, bytes));
    at += bytes;
  }
}

}  // namespace shoal::hosted

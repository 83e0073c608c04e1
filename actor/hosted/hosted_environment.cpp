// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/hosted_environment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "actor/hosted/hosted_spec.h"
#include "actor/worlds/episode_fault.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::hosted {
namespace {

using tasks::ArraySpace;
using tasks::ElementType;
using worlds::EpisodeFault;
using worlds::FaultCause;

template <class T>
void Convert(const void* array, std::span<float> numbers) {
  const T* from = static_cast<const T*>(array);
  for (size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(from[i]);
}

void ConvertTo(ElementType type, const void* array, std::span<float> numbers) {
  switch (type) {
    case ElementType::kFloat32:
      return Convert<float>(array, numbers);
    case ElementType::kFloat64:
      return Convert<double>(array, numbers);
    case ElementType::kUint8:
      return Convert<uint8_t>(array, numbers);
    case ElementType::kUint16:
      return Convert<uint16_t>(array, numbers);
    case ElementType::kUint32:
      return Convert<uint32_t>(array, numbers);
    case ElementType::kInt8:
      return Convert<int8_t>(array, numbers);
    case ElementType::kInt16:
      return Convert<int16_t>(array, numbers);
    case ElementType::kInt32:
      return Convert<int32_t>(array, numbers);
    case ElementType::kInt64:
      return Convert<int64_t>(array, numbers);
  }
}

bool IsBounded(const ArraySpace& space) {
  const auto finite = [](double bound) { return std::isfinite(bound); };
  return std::ranges::any_of(space.low, finite) || std::ranges::any_of(space.high, finite);
}

}  // namespace

HostedEnvironment::HostedEnvironment(tasks::EnvironmentDescription description,
                                     const Config& config, std::unique_ptr<RawEnvironment> raw)
    : description_(std::move(description)),
      task_(TaskOf(description_)),
      action_repeat_(task_.ActionRepeat(config.action_repeat)),
      end_on_success_(config.end_on_success),
      raw_(std::move(raw)),
      spec_(SpecOf(description_, config)),
      vector_(static_cast<size_t>(spec_.RecordedVectorSize())),
      action_(static_cast<size_t>(spec_.action_size)) {
  for (const std::string& name : spec_.cameras) {
    const ArraySpace* space = description_.Find(name);
    images_.push_back({.array = size_t(space - description_.observation.data()),
                       .resize = ImageResize(*ImageLayoutOf(*space), config.observation.grey,
                                             spec_.height, spec_.width)});
  }
  for (const BlockSpec& block : spec_.blocks) {
    const ArraySpace* space = description_.Find(block.name);
    CHECK(space != nullptr) << block.name;
    blocks_.push_back({.array = size_t(space - description_.observation.data()),
                       .first = size_t(spec_.Recorded(block.name)->first),
                       .bounded = IsBounded(*space)});
  }
}

void HostedEnvironment::ReadNumbers() {
  for (Block& block : blocks_) ReadBlock(&block);
}

void HostedEnvironment::ReadBlock(Block* block) {
  const ArraySpace& space = description_.observation[block->array];
  const std::span<float> numbers{vector_.data() + block->first, size_t(space.size())};
  ConvertTo(space.type, raw_->observation()[block->array], numbers);
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!std::isfinite(numbers[i])) {
      throw EpisodeFault(
          FaultCause::kObservation,
          fmt::format("environment {}: number {} of '{}' is {} after {} steps: not a finite "
                      "float32",
                      description_.id, i, space.name, numbers[i], steps_));
    }
    if (!block->bounded || block->warned) continue;
    const bool inside = numbers[i] >= static_cast<float>(space.Low(int(i))) &&
                        numbers[i] <= static_cast<float>(space.High(int(i)));
    if (!inside) WarnOutside(space, i, numbers[i], block);
  }
}

// Many environments leave their bounds by a rounding error, so that training goes on.
void HostedEnvironment::WarnOutside(const ArraySpace& space, size_t element, float value,
                                    Block* block) {
  block->warned = true;
  log::Warning(
      "environment {}: number {} of '{}' is {} after {} steps, outside of its declared bounds "
      "[{}, {}]; such numbers are used as they are, and this is the only warning for '{}'",
      description_.id, element, space.name, value, steps_, space.Low(int(element)),
      space.High(int(element)), space.name);
}

void HostedEnvironment::Observe(worlds::ObservationOut out) {
  CHECK(out.vector.size() == vector_.size()) << out.vector.size();
  CHECK(out.frame.size() == static_cast<size_t>(spec_.FrameBytes())) << out.frame.size();
  std::ranges::copy(vector_, out.vector.begin());
  if (images_.empty()) return;
  const ScopedSeconds timed(image_seconds_);
  const size_t plane = size_t(spec_.height) * size_t(spec_.width);
  size_t at = 0;
  for (Image& image : images_) {
    const size_t bytes = plane * size_t(image.resize.channels());
    image.resize.Apply(static_cast<const uint8_t*>(raw_->observation()[image.array]),
                       out.frame.subspan(at, bytes));
    at += bytes;
  }
}

double HostedEnvironment::Distance() const {
  if (task_.goal_size() == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto goal = [this](const char* name) {
    const ObservationSpec::Range range = *spec_.Recorded(name);
    return std::span<const float>(vector_).subspan(size_t(range.first), size_t(range.size));
  };
  return task_.Distance(goal(tasks::kAchievedGoal), goal(tasks::kDesiredGoal));
}

float HostedEnvironment::Reset(uint64_t stream_key, worlds::ObservationOut out) {
  // 31 bits: some environments seed generators that take no more.
  raw_->Reset(static_cast<uint32_t>(stream_key >> 33));
  steps_ = 0;
  ReadNumbers();
  Observe(out);
  return static_cast<float>(Distance());
}

void HostedEnvironment::MapAction(std::span<const float> action) {
  CHECK(action.size() == action_.size()) << action.size();
  for (size_t i = 0; i < action.size(); ++i) {
    if (!std::isfinite(action[i])) {
      throw NonFiniteError("action component {} is {}: not finite; the policy's weights are bad", i,
                           action[i]);
    }
    if (std::fabs(action[i]) > 1) {
      throw RuntimeError("action component {} is {}; expected a number in [-1, 1]", i, action[i]);
    }
    const double low = description_.action.Low(int(i)), high = description_.action.High(int(i));
    action_[i] = std::clamp(low + (double{action[i]} + 1) / 2 * (high - low), low, high);
  }
}

worlds::StepResult HostedEnvironment::Step(std::span<const float> action,
                                           worlds::ObservationOut out) {
  MapAction(action);
  worlds::StepResult result;
  double reward = 0;
  for (int i = 0; i < action_repeat_ && !result.terminated && !result.truncated; ++i) {
    const RawStep step = raw_->Step(action_);
    ++steps_;
    reward += step.reward;
    result.success = step.success.value_or(false);
    result.terminated = step.terminated || (end_on_success_ && result.success);
    result.truncated = step.truncated && !result.terminated;
  }
  result.reward = static_cast<float>(reward);
  if (!std::isfinite(result.reward)) {
    throw EpisodeFault(
        FaultCause::kReward,
        fmt::format("environment {}: the reward is {} after {} steps: not a finite float32",
                    description_.id, reward, steps_));
  }
  ReadNumbers();
  result.distance = static_cast<float>(Distance());
  Observe(out);
  return result;
}

}  // namespace shoal::hosted

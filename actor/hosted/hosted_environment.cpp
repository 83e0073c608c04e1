// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/hosted_environment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "actor/hosted/action_mapping.h"
#include "actor/hosted/hosted_spec.h"
#include "actor/worlds/episode_fault.h"
#include "common/base/check.h"
#include "common/base/error.h"
#include "common/wire/scoped_seconds.h"

namespace shoal::hosted {
namespace {

using worlds::EpisodeFault;
using worlds::FaultCause;

}  // namespace

HostedEnvironment::HostedEnvironment(tasks::EnvironmentDescription description,
                                     const Config& config, std::unique_ptr<RawEnvironment> raw)
    : description_(std::move(description)),
      task_(TaskOf(description_)),
      action_repeat_(task_.ActionRepeat(config.action_repeat)),
      end_on_success_(config.end_on_success),
      raw_(std::move(raw)),
      spec_(SpecOf(description_, config)),
      mapping_(description_, spec_),
      vector_(static_cast<size_t>(spec_.RecordedVectorSize())),
      action_(static_cast<size_t>(spec_.action_size)) {}

void HostedEnvironment::Observe(worlds::ObservationOut out) {
  CHECK(out.vector.size() == vector_.size()) << out.vector.size();
  CHECK(out.frame.size() == static_cast<size_t>(spec_.FrameBytes())) << out.frame.size();
  std::ranges::copy(vector_, out.vector.begin());
  if (mapping_.has_images()) mapping_.ReadFrame(raw_->observation(), out.frame);
}

double HostedEnvironment::Distance() const {
  if (task_.goal_size() == 0) return std::numeric_limits<double>::quiet_NaN();
  const auto goal = [this](const char* name) {
    const ObservationSpec::Range range = *spec_.Recorded(name);
    return std::span<const float>(vector_).subspan(static_cast<size_t>(range.first),
                                                   static_cast<size_t>(range.size));
  };
  return task_.Distance(goal(tasks::kAchievedGoal), goal(tasks::kDesiredGoal));
}

float HostedEnvironment::Reset(uint64_t stream_key, worlds::ObservationOut out) {
  {
    const ScopedSeconds timed(call_seconds_);
    // 31 bits: some environments pass the seed to generators that accept no more.
    raw_->Reset(static_cast<uint32_t>(stream_key >> 33));
  }
  steps_ = 0;
  mapping_.ReadVector(raw_->observation(), steps_, vector_);
  Observe(out);
  return static_cast<float>(Distance());
}

RawStep HostedEnvironment::TimedStep() {
  const ScopedSeconds timed(call_seconds_);
  return raw_->Step(action_);
}

worlds::StepResult HostedEnvironment::Step(std::span<const float> action,
                                           worlds::ObservationOut out) {
  MapAction(description_.action, action, action_);
  worlds::StepResult result;
  double reward = 0;
  for (int i = 0; i < action_repeat_ && !result.terminated && !result.truncated; ++i) {
    const RawStep step = TimedStep();
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
  mapping_.ReadVector(raw_->observation(), steps_, vector_);
  result.distance = static_cast<float>(Distance());
  Observe(out);
  return result;
}

}  // namespace shoal::hosted

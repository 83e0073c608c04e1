// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/episode_runner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "actor/worlds/episode_fault.h"
#include "common/base/check.h"

namespace shoal::actor {

EpisodeRunner::EpisodeRunner(std::unique_ptr<worlds::Environment> environment, PolicyInput input)
    : environment_(std::move(environment)),
      input_(input),
      observed_(BlockPicker::Observed(environment_->spec())),
      stack_(input.stack.first(size_t(environment_->spec().FrameBytes()) *
                               size_t(environment_->spec().stack)),
             environment_->spec().FrameBytes()) {
  const ObservationSpec& spec = environment_->spec();
  CHECK(input.stack.size() == size_t(spec.InputBytes())) << input.stack.size();
  CHECK(input.vector.size() == size_t(spec.VectorSize())) << input.vector.size();
}

float EpisodeRunner::Begin(uint64_t stream_key, worlds::ObservationOut out, int cut_after) {
  figures_ = {};
  cut_after_ = cut_after;
  last_action_.clear();
  running_ = false;
  try {
    distance_ = environment_->Reset(stream_key, out);
  } catch (const worlds::EpisodeFault&) {
    if (listener_ != nullptr) listener_->OnFault(input_.stack);
    throw;
  }
  const auto masses = environment_->drawn_masses();
  figures_.drawn_masses.assign(masses.begin(), masses.end());
  stack_.Reset(out.frame);
  const std::span<const uint8_t> goal = environment_->goal_picture();
  std::ranges::copy(goal, input_.stack.last(goal.size()).begin());
  observed_.Copy(out.vector, input_.vector);
  running_ = true;
  if (listener_ != nullptr) listener_->OnBegin(stream_key, input_.stack);
  return distance_;
}

worlds::StepResult EpisodeRunner::Step(std::span<const float> action, worlds::ObservationOut out) {
  CHECK(running_) << "a step without an episode";
  worlds::StepResult result;
  try {
    result = environment_->Step(action, out);
  } catch (const worlds::EpisodeFault&) {
    EndFaulty();
    throw;
  }
  distance_ = result.distance;
  if (figures_.length + 1 == cut_after_) result.truncated = !result.terminated;
  stack_.Push(out.frame);
  observed_.Copy(out.vector, input_.vector);
  running_ = !result.terminated && !result.truncated;
  AddToFigures(action, result);
  if (listener_ != nullptr) {
    listener_->OnStep({.stack = input_.stack,
                       .action = action,
                       .reward = result.reward,
                       .success = result.success,
                       .ended = !running_});
  }
  return result;
}

void EpisodeRunner::AddToFigures(std::span<const float> action, const worlds::StepResult& result) {
  if (!last_action_.empty()) {
    double squared = 0;
    for (size_t a = 0; a < action.size(); ++a) {
      squared += std::pow(double{action[a]} - double{last_action_[a]}, 2);
    }
    figures_.action_smoothness += std::sqrt(squared);
  }
  last_action_.assign(action.begin(), action.end());
  ++figures_.length;
  figures_.episode_return += result.reward;
  if (running_) return;
  CompleteFigures();
  figures_.success = result.success;
}

void EpisodeRunner::CompleteFigures() {
  // Turns the sum of action differences into a mean. An episode of one step has no difference.
  if (figures_.length > 1) figures_.action_smoothness /= figures_.length - 1;
  figures_.final_distance = distance_;
}

void EpisodeRunner::EndFaulty() {
  running_ = false;
  CompleteFigures();
  figures_.success = false;
  if (listener_ != nullptr) listener_->OnFault(input_.stack);
}

}  // namespace shoal::actor

// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/batch_gather.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::replay {

std::optional<BatchPlan> DrawPlan(const PlanOptions& options, Selector* selector,
                                  Relabeller* relabeller, Random* random) {
  CHECK(options.copies > 0 && options.batch % options.copies == 0)
      << options.copies << " copies in a batch of " << options.batch;
  const int target_shifts = options.target_shifts == 0 ? options.copies : options.target_shifts;
  const int critic_shifts = options.critic_shifts == 0 ? options.copies : options.critic_shifts;
  CHECK(options.copies % target_shifts == 0 && options.copies % critic_shifts == 0)
      << target_shifts << " and " << critic_shifts << " shifts of " << options.copies << " copies";
  BatchPlan plan;
  plan.elements.reserve(static_cast<size_t>(options.batch));
  std::optional<Selection> drawn;
  uint64_t goal = 0;
  for (int b = 0; b < options.batch; ++b) {
    const int copy = b % options.copies;
    if (copy == 0) {
      drawn = selector->Draw(random);
      if (!drawn) return std::nullopt;
      if (relabeller != nullptr) goal = relabeller->DrawGoal(drawn->id, random);
    }
    // Further copies reuse the shifts of earlier copies.
    const auto before = [&](int shifts) -> const BatchPlan::Element& {
      return plan.elements[static_cast<size_t>(b - shifts)];
    };
    const Shift obs =
        copy < critic_shifts ? DrawShift(options.shift_pad, random) : before(critic_shifts).obs;
    const Shift next_obs = copy < target_shifts ? DrawShift(options.shift_pad, random)
                                                : before(target_shifts).next_obs;
    plan.elements.push_back({.id = drawn->id,
                             .probability = drawn->probability,
                             .goal = goal,
                             .obs = obs,
                             .next_obs = next_obs});
    for (int h = 0; h < options.horizon; ++h) {
      plan.elements.back().steps.push_back(DrawShift(options.shift_pad, random));
    }
  }
  return plan;
}

size_t FrameCopies::CopiesOfPart() const {
  const auto frame_bytes =
      static_cast<size_t>(channels) * static_cast<size_t>(height) * static_cast<size_t>(width);
  return std::max<size_t>(1, kBytesOfPart / std::max<size_t>(1, frame_bytes));
}

int FrameCopies::parts() const {
  return static_cast<int>((copies.size() + CopiesOfPart() - 1) / CopiesOfPart());
}

void FrameCopies::MakePart(int part) const {
  const size_t begin = static_cast<size_t>(part) * CopiesOfPart();
  const size_t end = std::min(copies.size(), begin + CopiesOfPart());
  for (size_t i = begin; i < end; ++i) {
    const Copy& copy = copies[i];
    ShiftPlanes(copy.frame, channels, height, width, copy.shift, copy.out);
  }
}

BatchGather::BatchGather(const Ring& ring, const EpisodeIndex& index, const ObservationSpec& spec,
                         const NStep& n_step, const GoalChange* goals,
                         std::span<const std::string> privileged)
    : ring_(ring),
      index_(index),
      observed_(BlockPicker::Observed(spec)),
      privileged_(BlockPicker::Named(spec, privileged)),
      stack_(spec.stack),
      channels_(spec.channels),
      height_(spec.height),
      width_(spec.width),
      goal_pictures_(spec.goal_picture),
      n_step_(n_step),
      goals_(goals) {}

std::span<const float> BatchGather::GoalOf(const BatchPlan::Element& element) const {
  if (element.goal == 0) return {};
  CHECK(goals_ != nullptr) << "a goal for record " << element.id;
  return goals_->Achieved(ring_.Record(element.goal));
}

float BatchGather::Reward(uint64_t id, std::span<const float> goal) const {
  return goal.empty() ? ring_.Header(id).reward : goals_->Reward(ring_.Record(id), goal);
}

bool BatchGather::Terminated(uint64_t id, std::span<const float> goal) const {
  return goal.empty() ? (ring_.Header(id).flags & kTerminated) != 0
                      : goals_->Terminated(ring_.Record(id), goal);
}

BatchGather::Returns BatchGather::SumRewards(uint64_t first, std::span<const float> goal) const {
  uint64_t last = first;
  double reward = Reward(first, goal), discount = 1;
  // An episode that success ended would have continued under another goal, but no later step is
  // stored. Its last samples then sum fewer than n rewards and bootstrap after these.
  for (int k = 1; k < n_step_.steps && !Terminated(last, goal) && index_.Next(last) != 0; ++k) {
    last = index_.Next(last);
    discount *= n_step_.discount;
    reward += discount * Reward(last, goal);
  }
  const float bootstrap = Terminated(last, goal) ? 0.0f : static_cast<float>(discount);
  return {last, static_cast<float>(reward), bootstrap};
}

void BatchGather::AddFrame(uint64_t id, Shift shift, uint8_t* out, FrameCopies* copies) const {
  copies->copies.push_back({ring_.layout().Frame(ring_.Record(id)).data(), shift, out});
  copies->oldest = copies->oldest == 0 ? id : std::min(copies->oldest, id);
}

void BatchGather::AddStack(uint64_t id, Shift shift, uint8_t* out, FrameCopies* copies) const {
  const int frame_bytes = ring_.layout().frame_bytes();
  // The newest frame is the last, so the stack is filled from the back. Below the reset, the
  // reset's frame is repeated.
  for (int k = stack_ - 1; k >= 0; --k) {
    AddFrame(id, shift, out + k * frame_bytes, copies);
    if (ring_.Header(id).kind == RecordKind::kStep) id = ring_.Slot(id).prev;
  }
}

void BatchGather::AddPictures(const BatchPlan::Element& element, uint64_t id, Shift shift,
                              size_t row, std::span<uint8_t> frames, FrameCopies* copies) const {
  if (frames.empty()) return;
  uint8_t* out = frames.data() + row * InputBytes();
  AddStack(id, shift, out, copies);
  if (!goal_pictures_) return;
  const uint64_t shown = element.goal != 0 ? element.goal : index_.GoalRecord(element.id);
  AddFrame(shown, shift, out + ptrdiff_t{stack_} * ring_.layout().frame_bytes(), copies);
}

void BatchGather::GatherVectors(uint64_t id, std::span<const float> goal, size_t row,
                                std::span<float> vectors, std::span<float> privileged) const {
  const auto part = [row](std::span<float> all, int size) {
    return all.subspan(row * static_cast<size_t>(size), static_cast<size_t>(size));
  };
  const std::span<const float> recorded = ring_.layout().Vector(ring_.Record(id));
  const auto seen = part(vectors, observed_.size());
  const auto known = privileged.empty() ? privileged : part(privileged, privileged_.size());
  observed_.Copy(recorded, seen);
  if (!known.empty()) privileged_.Copy(recorded, known);
  if (!goal.empty()) goals_->WriteGoal(goal, seen, known);
}

void BatchGather::GatherSteps(const BatchPlan::Element& element, std::span<const float> goal,
                              size_t row, const BatchView& out, FrameCopies* copies) const {
  CHECK(element.steps.size() >= out.steps.size()) << element.steps.size() << " shifts";
  uint64_t id = element.id;  // 0: the sequence has ended
  for (size_t h = 0; h < out.steps.size(); ++h) {
    const StepView& step = out.steps[h];
    const auto row_of = [&](auto array) {
      const size_t size = array.size() / out.rows();
      return array.subspan(row * size, size);
    };
    step.present[row] = id != 0 ? 1 : 0;
    step.reward[row] = step.terminated[row] = 0;
    if (id == 0) {
      std::ranges::fill(row_of(step.next_frames), uint8_t{0});
      std::ranges::fill(row_of(step.next_vector), 0.f);
      std::ranges::fill(row_of(step.action), 0.f);
      continue;
    }
    const bool terminated = Terminated(id, goal);
    step.reward[row] = Reward(id, goal);
    step.terminated[row] = terminated ? 1 : 0;
    std::ranges::copy(ring_.layout().Action(ring_.Record(id)), row_of(step.action).begin());
    AddPictures(element, id, element.steps[h], row, step.next_frames, copies);
    GatherVectors(id, goal, row, step.next_vector, {});
    // An episode that success ended has no later step, also where another goal would go on.
    const bool ended = terminated || (ring_.Header(id).flags & kTerminated) != 0;
    id = ended ? 0 : index_.Next(id);
    CHECK(id != 0 || ended || h + 1 == out.steps.size())
        << "record " << element.id << ", step " << h;
  }
}

size_t BatchGather::InputBytes() const {
  return static_cast<size_t>(ring_.layout().frame_bytes()) *
         static_cast<size_t>(stack_ + (goal_pictures_ ? 1 : 0));
}

void BatchGather::Gather(const BatchPlan& plan, const BatchView& out) const {
  const FrameCopies copies = GatherAllButFrames(plan, out);
  for (int part = 0; part < copies.parts(); ++part) copies.MakePart(part);
}

FrameCopies BatchGather::GatherAllButFrames(const BatchPlan& plan, const BatchView& out) const {
  const RecordLayout& layout = ring_.layout();
  const size_t batch = plan.elements.size(), input_bytes = InputBytes();
  CHECK(out.obs_privileged.size() == batch * static_cast<size_t>(privileged_.size()));
  CHECK(out.reward.size() == batch && out.obs_frames.size() == batch * input_bytes &&
        out.obs_vector.size() == batch * static_cast<size_t>(observed_.size()) &&
        out.action.size() == batch * static_cast<size_t>(layout.action_size()))
      << "a batch of " << out.reward.size() << " for a plan of " << batch;
  const auto action_size = static_cast<size_t>(layout.action_size());
  FrameCopies copies{.copies = {}, .channels = channels_, .height = height_, .width = width_};
  if (input_bytes > 0) {
    copies.copies.reserve((2 + out.steps.size()) * batch *
                          static_cast<size_t>(stack_ + (goal_pictures_ ? 1 : 0)));
  }
  for (size_t b = 0; b < batch; ++b) {
    const BatchPlan::Element& element = plan.elements[b];
    const std::span<const float> goal = GoalOf(element);
    const Returns returns = SumRewards(element.id, goal);
    const uint8_t* first = ring_.Record(element.id);
    CHECK(RecordLayout::Header(first).kind == RecordKind::kStep && ring_.Slot(element.id).prev != 0)
        << "record " << element.id;
    const uint64_t before = ring_.Slot(element.id).prev;
    AddPictures(element, before, element.obs, b, out.obs_frames, &copies);
    AddPictures(element, returns.last, element.next_obs, b, out.next_obs_frames, &copies);
    GatherVectors(before, goal, b, out.obs_vector, out.obs_privileged);
    GatherVectors(returns.last, goal, b, out.next_obs_vector, out.next_obs_privileged);
    GatherSteps(element, goal, b, out, &copies);
    std::ranges::copy(layout.Action(first), out.action.data() + b * action_size);
    out.reward[b] = returns.reward;
    out.bootstrap[b] = returns.bootstrap;
    out.weights_update[b] = RecordLayout::Header(first).weights_update;
    out.id[b] = element.id;
    if (!out.probability.empty()) out.probability[b] = static_cast<float>(element.probability);
  }
  return copies;
}

}  // namespace shoal::replay

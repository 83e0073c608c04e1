#include "replay_server/core/batch_gather.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::replay {

std::optional<BatchPlan> DrawPlan(const PlanOptions& options, Selector* selector,
                                  Relabeller* relabeller, Random* random) {
  CHECK(options.copies > 0 && options.batch % options.copies == 0)
      << options.copies << " copies in a batch of " << options.batch;
  BatchPlan plan;
  plan.elements.reserve(static_cast<size_t>(options.batch));
  std::optional<Selection> drawn;
  uint64_t goal = 0;
  for (int b = 0; b < options.batch; ++b) {
    if (b % options.copies == 0) {
      drawn = selector->Draw(random);
      if (!drawn) return std::nullopt;
      if (relabeller != nullptr) goal = relabeller->DrawGoal(drawn->id, random);
    }
    const Shift obs = DrawShift(options.shift_pad, random);
    const Shift next_obs = DrawShift(options.shift_pad, random);
    plan.elements.push_back({.id = drawn->id,
                             .probability = drawn->probability,
                             .goal = goal,
                             .obs = obs,
                             .next_obs = next_obs});
  }
  return plan;
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
      n_step_(n_step),
      goals_(goals) {}

std::span<const float> BatchGather::GoalOf(const BatchPlan::Element& element) const {
  if (element.goal == 0) return {};
  CHECK(goals_ != nullptr) << "a goal for record " << element.id;
  return goals_->Achieved(ring_.Record(element.goal));
}

BatchGather::Returns BatchGather::SumRewards(uint64_t first, std::span<const float> goal) const {
  const auto earned = [&](uint64_t id) {
    return goal.empty() ? ring_.Header(id).reward : goals_->Reward(ring_.Record(id), goal);
  };
  const auto terminated = [this](uint64_t id) {
    return (ring_.Header(id).flags & kTerminated) != 0;
  };
  uint64_t last = first;
  double reward = earned(first), discount = 1;
  for (int k = 1; k < n_step_.steps && !terminated(last) && index_.Next(last) != 0; ++k) {
    last = index_.Next(last);
    discount *= n_step_.discount;
    reward += discount * earned(last);
  }
  return {last, static_cast<float>(reward), terminated(last) ? 0.0f : static_cast<float>(discount)};
}

void BatchGather::GatherStack(uint64_t id, Shift shift, uint8_t* out) const {
  const int frame_bytes = ring_.layout().frame_bytes();
  // Newest frame last: fill from the back, staying on the reset once it is reached.
  for (int k = stack_ - 1; k >= 0; --k) {
    const uint8_t* frame = ring_.layout().Frame(ring_.Record(id)).data();
    ShiftPlanes(frame, channels_, height_, width_, shift, out + k * frame_bytes);
    const uint64_t prev = ring_.Slot(id).prev;
    if (prev != 0) id = prev;
  }
}

void BatchGather::Gather(const BatchPlan& plan, const BatchView& out) const {
  const RecordLayout& layout = ring_.layout();
  const size_t batch = plan.elements.size();
  const size_t stack_bytes =
      static_cast<size_t>(layout.frame_bytes()) * static_cast<size_t>(stack_);
  const size_t vector_size = static_cast<size_t>(observed_.size());
  const size_t privileged_size = static_cast<size_t>(privileged_.size());
  const size_t action_size = static_cast<size_t>(layout.action_size());
  CHECK(out.obs_privileged.size() == batch * privileged_size);
  CHECK(out.reward.size() == batch && out.obs_frames.size() == batch * stack_bytes &&
        out.obs_vector.size() == batch * vector_size && out.action.size() == batch * action_size)
      << "a batch of " << out.reward.size() << " for a plan of " << batch;
  for (size_t b = 0; b < batch; ++b) {
    const BatchPlan::Element& element = plan.elements[b];
    const std::span<const float> goal = GoalOf(element);
    const Returns returns = SumRewards(element.id, goal);
    const uint8_t* first = ring_.Record(element.id);
    const uint8_t* last = ring_.Record(returns.last);
    const uint64_t prev = ring_.Slot(element.id).prev;
    CHECK(RecordLayout::Header(first).kind == RecordKind::kStep && prev != 0)
        << "record " << element.id;
    if (stack_bytes > 0) {
      GatherStack(prev, element.obs, out.obs_frames.data() + b * stack_bytes);
      GatherStack(returns.last, element.next_obs, out.next_obs_frames.data() + b * stack_bytes);
    }
    const auto obs = out.obs_vector.subspan(b * vector_size, vector_size);
    const auto next_obs = out.next_obs_vector.subspan(b * vector_size, vector_size);
    observed_.Copy(layout.Vector(ring_.Record(prev)), obs);
    observed_.Copy(layout.Vector(last), next_obs);
    if (privileged_size > 0) {
      const auto part = [&](std::span<float> all) {
        return all.subspan(b * privileged_size, privileged_size);
      };
      privileged_.Copy(layout.Vector(ring_.Record(prev)), part(out.obs_privileged));
      privileged_.Copy(layout.Vector(last), part(out.next_obs_privileged));
    }
    if (!goal.empty()) {
      goals_->WriteGoal(goal, obs);
      goals_->WriteGoal(goal, next_obs);
    }
    std::ranges::copy(layout.Action(first), out.action.data() + b * action_size);
    out.reward[b] = returns.reward;
    out.bootstrap[b] = returns.bootstrap;
    out.weights_update[b] = RecordLayout::Header(first).weights_update;
    out.id[b] = element.id;
  }
}

}  // namespace shoal::replay

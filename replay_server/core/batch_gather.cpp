#include "replay_server/core/batch_gather.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::replay {

std::optional<BatchPlan> DrawPlan(const PlanOptions& options, Sampler* sampler, Random* random) {
  CHECK(options.copies > 0 && options.batch % options.copies == 0)
      << options.copies << " copies in a batch of " << options.batch;
  BatchPlan plan;
  plan.elements.reserve(static_cast<size_t>(options.batch));
  std::optional<uint64_t> id;
  for (int b = 0; b < options.batch; ++b) {
    if (b % options.copies == 0) id = sampler->Draw(random);
    if (!id) return std::nullopt;
    const Shift obs = DrawShift(options.shift_pad, random);
    const Shift next_obs = DrawShift(options.shift_pad, random);
    plan.elements.push_back({*id, obs, next_obs});
  }
  return plan;
}

BatchGather::BatchGather(const Ring& ring, const ObservationSpec& spec, const NStep& n_step)
    : ring_(ring),
      stack_(spec.stack),
      channels_(spec.channels),
      height_(spec.height),
      width_(spec.width),
      n_step_(n_step),
      last_discount_(static_cast<float>(std::pow(n_step.discount, n_step.steps - 1))) {}

BatchGather::Returns BatchGather::SumRewards(uint64_t last) const {
  uint64_t first = last;
  double reward = ring_.Header(last).reward;
  for (int k = 1; k < n_step_.steps; ++k) {
    first = ring_.Slot(first).prev;
    reward = ring_.Header(first).reward + n_step_.discount * reward;
  }
  return {first, static_cast<float>(reward)};
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
  const size_t vector_size = static_cast<size_t>(layout.vector_size());
  const size_t action_size = static_cast<size_t>(layout.action_size());
  CHECK(out.reward.size() == batch && out.obs_frames.size() == batch * stack_bytes &&
        out.obs_vector.size() == batch * vector_size && out.action.size() == batch * action_size)
      << "a batch of " << out.reward.size() << " for a plan of " << batch;
  for (size_t b = 0; b < batch; ++b) {
    const BatchPlan::Element& element = plan.elements[b];
    const Returns returns = SumRewards(element.id);
    const uint8_t* first = ring_.Record(returns.first);
    const uint8_t* last = ring_.Record(element.id);
    const uint64_t prev = ring_.Slot(returns.first).prev;
    CHECK(RecordLayout::Header(first).kind == RecordKind::kStep && prev != 0)
        << "record " << element.id;
    if (stack_bytes > 0) {
      GatherStack(prev, element.obs, out.obs_frames.data() + b * stack_bytes);
      GatherStack(element.id, element.next_obs, out.next_obs_frames.data() + b * stack_bytes);
    }
    std::ranges::copy(layout.Vector(ring_.Record(prev)), out.obs_vector.data() + b * vector_size);
    std::ranges::copy(layout.Vector(last), out.next_obs_vector.data() + b * vector_size);
    std::ranges::copy(layout.Action(first), out.action.data() + b * action_size);
    out.reward[b] = returns.reward;
    const bool terminated = (RecordLayout::Header(last).flags & kTerminated) != 0;
    out.bootstrap[b] = terminated ? 0.0f : last_discount_;
    out.weights_update[b] = RecordLayout::Header(first).weights_update;
  }
}

}  // namespace shoal::replay

#include "replay_server/core/batch_gather.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::replay {

std::optional<BatchPlan> DrawPlan(int batch, int shift_pad, Sampler* sampler, Random* random) {
  BatchPlan plan;
  plan.elements.reserve(static_cast<size_t>(batch));
  for (int b = 0; b < batch; ++b) {
    const std::optional<uint64_t> id = sampler->Draw(random);
    if (!id) return std::nullopt;
    const Shift obs = DrawShift(shift_pad, random);
    const Shift next_obs = DrawShift(shift_pad, random);
    plan.elements.push_back({*id, obs, next_obs});
  }
  return plan;
}

BatchGather::BatchGather(const Ring& ring, const ObservationSpec& spec)
    : ring_(ring),
      stack_(spec.stack),
      channels_(spec.channels),
      height_(spec.height),
      width_(spec.width) {}

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
    const uint8_t* record = ring_.Record(element.id);
    const RecordHeader& header = RecordLayout::Header(record);
    const uint64_t prev = ring_.Slot(element.id).prev;
    CHECK(header.kind == RecordKind::kStep && prev != 0) << "record " << element.id;
    if (stack_bytes > 0) {
      GatherStack(prev, element.obs, out.obs_frames.data() + b * stack_bytes);
      GatherStack(element.id, element.next_obs, out.next_obs_frames.data() + b * stack_bytes);
    }
    std::ranges::copy(layout.Vector(ring_.Record(prev)), out.obs_vector.data() + b * vector_size);
    std::ranges::copy(layout.Vector(record), out.next_obs_vector.data() + b * vector_size);
    std::ranges::copy(layout.Action(record), out.action.data() + b * action_size);
    out.reward[b] = header.reward;
    out.bootstrap[b] = (header.flags & kTerminated) != 0 ? 0.0f : 1.0f;
    out.weights_update[b] = header.weights_update;
  }
}

}  // namespace shoal::replay

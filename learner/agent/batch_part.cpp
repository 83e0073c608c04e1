#include "learner/agent/batch_part.h"

#include "common/base/check.h"

namespace shoal::learner {
namespace {

template <class T>
std::span<T> PartOf(std::span<T> array, size_t index, size_t parts) {
  CHECK(array.size() % parts == 0) << array.size() << " numbers in " << parts << " parts";
  const size_t size = array.size() / parts;
  return array.subspan(index * size, size);
}

}  // namespace

BatchView PartOf(const BatchView& batch, int index, int parts) {
  if (parts == 1) return batch;
  CHECK(batch.reward.size() % size_t(parts) == 0) << batch.reward.size() << " rows";
  const auto part = [&](auto array) { return PartOf(array, size_t(index), size_t(parts)); };
  return {.obs_frames = part(batch.obs_frames),
          .next_obs_frames = part(batch.next_obs_frames),
          .obs_vector = part(batch.obs_vector),
          .next_obs_vector = part(batch.next_obs_vector),
          .action = part(batch.action),
          .reward = part(batch.reward),
          .bootstrap = part(batch.bootstrap),
          .obs_privileged = part(batch.obs_privileged),
          .next_obs_privileged = part(batch.next_obs_privileged),
          .weights_update = part(batch.weights_update),
          .id = part(batch.id),
          .drawn_action = part(batch.drawn_action),
          .log_prob = part(batch.log_prob),
          .ends = part(batch.ends),
          .continues = part(batch.continues),
          .stored_steps = batch.stored_steps};
}

}  // namespace shoal::learner

// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/minibatch.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::learner {
namespace {

// Gathers rows of `width` numbers.
template <class T>
void GatherRows(std::span<const T> from, size_t width, std::span<const int> rows,
                std::vector<T>* to) {
  for (size_t b = 0; b < rows.size(); ++b) {
    std::ranges::copy(from.subspan(size_t(rows[b]) * width, width),
                      to->begin() + std::ptrdiff_t(b * width));
  }
}

}  // namespace

Minibatch::Minibatch(const ObservationSpec& spec, int batch)
    : batch_(size_t(batch)),
      frame_bytes_(size_t(spec.InputBytes())),
      vector_size_(size_t(spec.VectorSize())),
      action_size_(size_t(spec.action_size)),
      frames_(batch_ * frame_bytes_),
      vectors_(batch_ * vector_size_),
      drawn_(batch_ * action_size_),
      reward_(batch_),
      log_prob_(batch_) {}

void Minibatch::TakeObservations(std::span<const uint8_t> frames, std::span<const float> vectors,
                                 std::span<const int> rows) {
  CHECK(rows.size() <= batch_) << rows.size() << " rows";
  if (frame_bytes_ > 0) GatherRows(frames, frame_bytes_, rows, &frames_);
  if (vector_size_ > 0) GatherRows(vectors, vector_size_, rows, &vectors_);
}

void Minibatch::Take(const BatchView& rollout, std::span<const int> rows) {
  CHECK(rows.size() == batch_) << rows.size() << " rows";
  TakeObservations(rollout.obs_frames, rollout.obs_vector, rows);
  GatherRows<float>(rollout.drawn_action, action_size_, rows, &drawn_);
  GatherRows<float>(rollout.reward, 1, rows, &reward_);
  GatherRows<float>(rollout.log_prob, 1, rows, &log_prob_);
}

BatchView Minibatch::View() {
  BatchView view;
  view.obs_frames = frames_;
  view.obs_vector = vectors_;
  view.drawn_action = drawn_;
  view.reward = reward_;
  view.log_prob = log_prob_;
  return view;
}

}  // namespace shoal::learner

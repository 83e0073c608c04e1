#include "common/wire/batch_layout.h"

#include "common/base/check.h"

namespace shoal {

BatchLayout::BatchLayout(const ObservationSpec& spec, int batch)
    : batch_(batch),
      frame_stack_bytes_(spec.FrameBytes() * spec.stack),
      vector_size_(spec.VectorSize()),
      action_size_(spec.action_size) {
  CHECK(batch > 0);
  const uint64_t b = static_cast<uint64_t>(batch);
  const uint64_t sizes[8] = {b * frame_stack_bytes_,
                             b * frame_stack_bytes_,
                             b * vector_size_ * 4,
                             b * vector_size_ * 4,
                             b * action_size_ * 4,
                             b * 4,
                             b * 4,
                             b * 8};
  uint64_t offset = 0;
  for (int i = 0; i < 8; ++i) {
    offsets_[i] = offset;
    offset = (offset + sizes[i] + 63) / 64 * 64;
  }
  total_bytes_ = offset;
}

BatchView BatchLayout::View(uint8_t* data) const {
  CHECK(reinterpret_cast<uintptr_t>(data) % 64 == 0);
  const size_t b = static_cast<size_t>(batch_);
  auto floats = [&](int i, size_t n) {
    return std::span<float>(reinterpret_cast<float*>(data + offsets_[i]), n);
  };
  return {.obs_frames = {data + offsets_[0], b * frame_stack_bytes_},
          .next_obs_frames = {data + offsets_[1], b * frame_stack_bytes_},
          .obs_vector = floats(2, b * vector_size_),
          .next_obs_vector = floats(3, b * vector_size_),
          .action = floats(4, b * action_size_),
          .reward = floats(5, b),
          .bootstrap = floats(6, b),
          .weights_update = {reinterpret_cast<uint64_t*>(data + offsets_[7]), b}};
}

}  // namespace shoal

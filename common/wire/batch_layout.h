// Layout of a batch in memory and on the wire: eight arrays one after another, each starting at a
// multiple of 64 bytes.
//
//   obs_frames       (B, K*C, H, W) u8   shifted (DrQ), frames of a stack oldest first
//   next_obs_frames  (B, K*C, H, W) u8   shifted with offsets of their own
//   obs_vector       (B, V) f32
//   next_obs_vector  (B, V) f32
//   action           (B, A) f32
//   reward           (B) f32             discounted sum over the sample's n steps
//   bootstrap        (B) f32             factor of the next value besides the discount: 0 where the
//                                        task ended, else discount^(n-1)
//   weights_update   (B) u64             of the policy that chose the action; for policy lag
//
// K*C channels: stack K, frame channels C. Arrays of a spec without pixels have size 0.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/observation_spec.h"

namespace shoal {

struct BatchView {
  std::span<uint8_t> obs_frames, next_obs_frames;
  std::span<float> obs_vector, next_obs_vector, action, reward, bootstrap;
  std::span<uint64_t> weights_update;
};

class BatchLayout {
 public:
  BatchLayout(const ObservationSpec& spec, int batch);

  int batch() const { return batch_; }
  int frame_stack_bytes() const { return frame_stack_bytes_; }
  uint64_t total_bytes() const { return total_bytes_; }
  // `data` holds total_bytes(), aligned to 64; the view borrows it.
  BatchView View(uint8_t* data) const;

 private:
  int batch_, frame_stack_bytes_, vector_size_, action_size_;
  uint64_t offsets_[8];
  uint64_t total_bytes_;
};

}  // namespace shoal

// From chosen steps to a batch in the layout of common/wire/batch_layout.h: stacks and next
// observations are put together here, out of frames that are stored once.
//
//   obs       = the K frames ending at the step's predecessor
//   next_obs  = the K frames ending at the step itself
//   a stack that would reach before the episode's reset repeats the reset's frame
//   bootstrap = 1 - terminated: a time limit's end counts the next value
//
// K stack, C channels of a frame, H W pixels, B batch.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/random.h"
#include "common/spec/observation_spec.h"
#include "common/wire/batch_layout.h"
#include "replay_server/core/random_shift.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/sampler.h"

namespace shoal::replay {

// What a batch will hold, drawn before anything is copied.
struct BatchPlan {
  struct Element {
    uint64_t id = 0;  // of the step
    Shift obs, next_obs;
  };
  std::vector<Element> elements;  // B
};

// Per element: the step's id, the shift of obs, the shift of next_obs. Nothing when the sampler
// finds no step.
std::optional<BatchPlan> DrawPlan(int batch, int shift_pad, Sampler* sampler, Random* random);

class BatchGather {
 public:
  // Borrows the ring.
  BatchGather(const Ring& ring, const ObservationSpec& spec);

  // Writes every byte of the arrays in `out`, whose batch is plan.elements.size() (CHECKed). The
  // steps must be sampleable.
  void Gather(const BatchPlan& plan, const BatchView& out) const;

 private:
  // Writes the stack of K frames that ends at record `id` to `out` (K*C, H, W).
  void GatherStack(uint64_t id, Shift shift, uint8_t* out) const;

  const Ring& ring_;
  const int stack_, channels_, height_, width_;
};

}  // namespace shoal::replay

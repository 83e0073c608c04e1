// From chosen steps to a batch in the layout of common/wire/batch_layout.h: stacks and next
// observations are put together here, out of frames that are stored once.
//
// A sample is n steps in a row, t .. t+n-1, known by the last one (Eq. 14 of docs/algorithm.md):
//
//   obs       = the K frames ending at the predecessor of step t
//   action    = that of step t
//   reward    = r_t + discount r_(t+1) + ... + discount^(n-1) r_(t+n-1)
//   next_obs  = the K frames ending at step t+n-1
//   bootstrap = discount^(n-1) (1 - terminated): a time limit's end counts the next value
//   a stack that would reach before the episode's reset repeats the reset's frame
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
    uint64_t id = 0;  // of the last step
    Shift obs, next_obs;
  };
  std::vector<Element> elements;  // B
};

struct PlanOptions {
  int batch = 1;      // B
  int copies = 1;     // elements in a row with the same step; divides B
  int shift_pad = 0;  // pixels
};

// For every `copies` elements a step's id; for each element the shift of obs and that of next_obs.
// Nothing when the sampler finds no step.
std::optional<BatchPlan> DrawPlan(const PlanOptions& options, Sampler* sampler, Random* random);

struct NStep {
  int steps = 1;  // n
  double discount = 1;
};

class BatchGather {
 public:
  // Borrows the ring.
  BatchGather(const Ring& ring, const ObservationSpec& spec, const NStep& n_step = {});

  // Writes every byte of the arrays in `out`, whose batch is plan.elements.size() (CHECKed). The
  // steps must be sampleable for this stack and n.
  void Gather(const BatchPlan& plan, const BatchView& out) const;

 private:
  // The first step of the sample that ends at `last`, and the reward from there on.
  struct Returns {
    uint64_t first;
    float reward;
  };
  Returns SumRewards(uint64_t last) const;
  // Writes the stack of K frames that ends at record `id` to `out` (K*C, H, W).
  void GatherStack(uint64_t id, Shift shift, uint8_t* out) const;

  const Ring& ring_;
  const int stack_, channels_, height_, width_;
  const NStep n_step_;
  const float last_discount_;  // discount^(n-1)
};

}  // namespace shoal::replay

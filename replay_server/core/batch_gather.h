// SPDX-License-Identifier: Apache-2.0
// Makes a batch (common/wire/batch_schema.h) of drawn steps. Stacks and next observations are
// assembled from frames that the ring stores once.
//
// A sample consists of m consecutive steps t .. t+m-1; its id is that of its first step (Eq. 14 of
// docs/algorithm.md). m = n, or less if step t+m-1 terminated the episode:
//
//   obs       = the K frames that end at the predecessor of step t
//   action    = the action of step t
//   reward    = r_t + discount r_(t+1) + ... + discount^(m-1) r_(t+m-1)
//   next_obs  = the K frames that end at step t+m-1
//   bootstrap = discount^(m-1) (1 - terminated); after a time limit, the next value counts
//
// If a stack would begin before the episode's reset, the frame of the reset is repeated.
//
// If the spec has goal pictures, the two observations end with one more frame: the frame of the
// episode's goal record. The goal frame is shifted like the stack of the same observation, so that
// distances between the two pictures are kept.
//
// If a sample is relabelled with another goal (goal_change.h), the rewards, the termination and the
// desired goal of the two observations are computed for the new goal. The goal picture is then the
// frame of the record that achieved the new goal. If episodes end on success, the sample ends with
// the step that reaches the new goal. If the episode reached its own goal after fewer than n steps,
// the sample ends with the episode: m < n, and the target bootstraps.
//
// If the batch has sequences, step h of a sample is the h-th step from its first step on, whatever
// m is, and its observation afterwards is shifted by offsets of its own. A step that terminates the
// sample's episode is the last step of the sequence, and so is the last stored step.
//
// Dimensions: B batch, K frames of a stack, C channels of a frame, (H, W) height and width, I input
// channels (K*C, or (K+1)*C with goal pictures).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/spec/observation_spec.h"
#include "common/wire/batch_schema.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/goal_change.h"
#include "replay_server/core/random_shift.h"
#include "replay_server/core/relabeller.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/selector.h"

namespace shoal::replay {

// The elements of a batch. They are drawn before any data are copied.
struct BatchPlan {
  struct Element {
    uint64_t id = 0;         // record id of the first step
    double probability = 0;  // probability of the draw
    uint64_t goal = 0;       // record whose achieved goal replaces the goal; 0 = not relabelled
    Shift obs, next_obs;
    std::vector<Shift> steps{};  // of the observation after each step of a sequence
  };
  std::vector<Element> elements;  // B
};

struct PlanOptions {
  int batch = 1;          // B
  int copies = 1;         // consecutive elements with the same step; divides B
  int target_shifts = 0;  // different shifts of next_obs in a group of copies; 0 = copies
  int critic_shifts = 0;  // different shifts of obs in a group of copies; 0 = copies
  int horizon = 0;        // steps of a sequence
  int shift_pad = 0;      // pixels
};

// `target_shifts` and `critic_shifts` must divide `copies`.
//
// Draws a step for every group of `copies` elements and, if there is a relabeller, a goal. Element
// i of a group gets a new shift of obs if i < critic_shifts, else the shift of element i -
// critic_shifts. Shifts of next_obs are drawn in the same way with target_shifts. Returns empty if
// the selector finds no step.
std::optional<BatchPlan> DrawPlan(const PlanOptions& options, Selector* selector,
                                  Relabeller* relabeller, Random* random);

// Frames of a batch that are still to be copied, from the ring to the batch. The frames of the ring
// do not change until the record `oldest` is overwritten. The copies are independent of each other:
// any threads may make them, in any order. A value type that borrows ring and batch.
struct FrameCopies {
  struct Copy {
    const uint8_t* frame;
    Shift shift;
    uint8_t* out;
  };
  // Makes the copies of part 0 <= part < parts().
  void MakePart(int part) const;
  // Parts have about kBytesOfPart bytes, and at least one frame.
  int parts() const;
  static constexpr size_t kBytesOfPart = 512 * 1024;

  std::vector<Copy> copies;
  int channels = 0, height = 0, width = 0;  // of a frame
  uint64_t oldest = 0;                      // lowest id of the copied records; 0 = no copies

 private:
  size_t CopiesOfPart() const;
};

struct NStep {
  int steps = 1;  // n
  double discount = 1;
};

class BatchGather {
 public:
  // Borrows the ring, the index and `goals`. `goals` relabels transitions; null: no sample is
  // relabelled. `privileged`: as in BatchOptions.
  BatchGather(const Ring& ring, const EpisodeIndex& index, const ObservationSpec& spec,
              const NStep& n_step = {}, const GoalChange* goals = nullptr,
              std::span<const std::string> privileged = {});

  // Writes every byte of the arrays in `out`, whose batch is plan.elements.size() (CHECKed). The
  // steps must be sampleable for this stack and n.
  void Gather(const BatchPlan& plan, const BatchView& out) const;
  // Does the same except for the frames. Returns the copies that write the frames.
  FrameCopies GatherAllButFrames(const BatchPlan& plan, const BatchView& out) const;

 private:
  size_t InputBytes() const;  // bytes of one observation's pictures
  // The goal of a relabelled element; empty for other elements.
  std::span<const float> GoalOf(const BatchPlan::Element& element) const;
  // Reward and end of a step; `goal` empty: those of the record.
  float Reward(uint64_t id, std::span<const float> goal) const;
  bool Terminated(uint64_t id, std::span<const float> goal) const;
  // The last step of a sample, its reward and its bootstrap.
  struct Returns {
    uint64_t last;
    float reward, bootstrap;
  };
  Returns SumRewards(uint64_t first, std::span<const float> goal) const;
  void AddFrame(uint64_t id, Shift shift, uint8_t* out, FrameCopies* copies) const;
  // Adds the copies of the stack of K frames that ends at record `id` to `out` (K*C, H, W).
  void AddStack(uint64_t id, Shift shift, uint8_t* out, FrameCopies* copies) const;
  // Adds the copies of one observation of an element, the stack that ends at record `id` and the
  // goal picture (I, H, W), to row `row` of `frames`.
  void AddPictures(const BatchPlan::Element& element, uint64_t id, Shift shift, size_t row,
                   std::span<uint8_t> frames, FrameCopies* copies) const;
  // Writes the vectors of record `id` to row `row`.
  void GatherVectors(uint64_t id, std::span<const float> goal, size_t row, std::span<float> vectors,
                     std::span<float> privileged) const;
  // Fills in row `row` of the steps of a sequence.
  void GatherSteps(const BatchPlan::Element& element, std::span<const float> goal, size_t row,
                   const BatchView& out, FrameCopies* copies) const;

  const Ring& ring_;
  const EpisodeIndex& index_;
  const BlockPicker observed_, privileged_;
  const int stack_, channels_, height_, width_;
  const bool goal_pictures_;
  const NStep n_step_;
  const GoalChange* const goals_;
};

}  // namespace shoal::replay

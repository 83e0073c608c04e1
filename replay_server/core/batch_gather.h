// SPDX-License-Identifier: Apache-2.0
// Makes a batch (common/wire/batch_schema.h) of drawn steps: assembles stacks and next observations
// from frames that are stored once.
//
// A sample is m steps in a row, t .. t+m-1, known by the first one (Eq. 14 of docs/algorithm.md);
// m = n, or less where step t+m-1 terminated the episode:
//
//   obs       = the K frames ending at the predecessor of step t
//   action    = that of step t
//   reward    = r_t + discount r_(t+1) + ... + discount^(m-1) r_(t+m-1)
//   next_obs  = the K frames ending at step t+m-1
//   bootstrap = discount^(m-1) (1 - terminated): a time limit's end counts the next value
//   a stack that would reach before the episode's reset repeats the reset's frame
//
// If the spec has goal pictures, both observations end with one more frame: the one of the
// episode's goal record. It is shifted like the stack before it, so that distances between the two
// pictures are kept.
//
// Under another goal (goal_change.h) rewards, terminations and the desired goal of both
// observations are those of that goal, whose picture is the frame of the record that achieved it.
// Where episodes end on success the sample ends with the step that reaches it; and where the
// episode ended before n steps because it reached its own, with the episode, m < n, and bootstraps.
//
// K stack, C channels of a frame, H W pixels, B batch.
#pragma once

#include <cstdint>
#include <functional>
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

// The elements of a batch, drawn before anything is copied.
struct BatchPlan {
  struct Element {
    uint64_t id = 0;         // of the first step
    double probability = 0;  // with which it was drawn
    uint64_t goal = 0;       // the record whose achieved goal is its goal; 0 = its own
    Shift obs, next_obs;
  };
  std::vector<Element> elements;  // B
};

struct PlanOptions {
  int batch = 1;          // B
  int copies = 1;         // c: elements in a row with the same step; divides B
  int target_shifts = 0;  // K: different shifts of next_obs among c; divides c, 0 = c
  int critic_shifts = 0;  // M: the same of obs
  int shift_pad = 0;      // pixels
};

// For every `copies` elements a step's id and, with a relabeller, its goal; for the i-th of them
// the shift of obs, drawn for i < M and then that of i - M, and the shift of next_obs, likewise
// with K. Nothing when the selector finds no step.
std::optional<BatchPlan> DrawPlan(const PlanOptions& options, Selector* selector,
                                  Relabeller* relabeller, Random* random);

// Calls part(0) .. part(parts - 1), each once, on any threads and in any order; returns when all
// have returned.
using RunParts = std::function<void(int parts, const std::function<void(int part)>& part)>;

struct NStep {
  int steps = 1;  // n
  double discount = 1;
};

class BatchGather {
 public:
  // Borrows ring, index and, where plans have goals, how these change a transition. `privileged` as
  // BatchOptions has it.
  BatchGather(const Ring& ring, const EpisodeIndex& index, const ObservationSpec& spec,
              const NStep& n_step = {}, const GoalChange* goals = nullptr,
              std::span<const std::string> privileged = {});

  // Writes every byte of the arrays in `out`, whose batch is plan.elements.size() (CHECKed). The
  // steps must be sampleable for this stack and n.
  //
  // `run` (null: the calling thread) may share the elements among threads: kElementsOfPart of them
  // are a part. The bytes do not depend on how.
  void Gather(const BatchPlan& plan, const BatchView& out, const RunParts& run = nullptr) const;

  static constexpr int kElementsOfPart = 4;  // 340 kB of two cameras' frames

 private:
  size_t InputBytes() const;  // of one observation's pictures
  // The elements [begin, end) of the plan, as Gather.
  void GatherElements(const BatchPlan& plan, size_t begin, size_t end, const BatchView& out) const;
  // The goal of an element that has another than its own, else nothing.
  std::span<const float> GoalOf(const BatchPlan::Element& element) const;
  // The last step of a sample, its reward and its bootstrap.
  struct Returns {
    uint64_t last;
    float reward, bootstrap;
  };
  Returns SumRewards(uint64_t first, std::span<const float> goal) const;
  // Writes the stack of K frames that ends at record `id` to `out` (K*C, H, W).
  void GatherStack(uint64_t id, Shift shift, uint8_t* out) const;
  // Both observations of the element whose last step is `last`: stacks and goal pictures (I, H, W).
  void GatherPictures(const BatchPlan::Element& element, uint64_t last, uint8_t* obs,
                      uint8_t* next_obs) const;
  void GatherVectors(const BatchPlan::Element& element, uint64_t last, std::span<const float> goal,
                     size_t row, const BatchView& out) const;

  const Ring& ring_;
  const EpisodeIndex& index_;
  const BlockPicker observed_, privileged_;
  const int stack_, channels_, height_, width_;
  const bool goal_pictures_;
  const NStep n_step_;
  const GoalChange* const goals_;
};

}  // namespace shoal::replay

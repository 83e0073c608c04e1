// SPDX-License-Identifier: Apache-2.0
// Layout of a batch: named arrays, each with a type and a shape, one after another. Each array
// starts at a multiple of 64 bytes. Learner and replay each make the schema from the same
// observation spec and the same options. Every request contains the schema's hash, so that the
// learner never reads a batch of another layout.
//
//   obs_frames       (B, K*C, H, W) u8   shifted (DrQ), frames of a stack oldest first
//   next_obs_frames  (B, K*C, H, W) u8   shifted by other offsets than obs_frames
//   obs_vector       (B, V) f32
//   next_obs_vector  (B, V) f32
//   obs_privileged       (B, P) f32      privileged blocks (BatchOptions::privileged), record order
//   next_obs_privileged  (B, P) f32
//   action           (B, A) f32
//   reward           (B) f32             discounted sum over the sample's n steps
//   bootstrap        (B) f32             factor of the next value in addition to the discount: 0 if
//                                        the task ended; discount^(m-1) for a sample of m steps
//   weights_update   (B) u64             update of the policy that chose the action, for policy lag
//   id               (B) u64             id of the sample's first record
//   probability      (B) f32             probability of the sample in one draw; only with
//                                        BatchOptions::probabilities
//
// Arrays of step h = 1 .. H of a sample's sequence, only with BatchOptions::horizon. Step 1 is the
// step of `action`:
//
//   step{h}.next_frames  (B, K*C, H, W) u8   observation after the step, shifted by own offsets
//   step{h}.next_vector  (B, V) f32
//   step{h}.action       (B, A) f32
//   step{h}.reward       (B) f32             reward of this step alone
//   step{h}.terminated   (B) f32             1: this step ended the task; else 0
//   step{h}.present      (B) f32             0: the sequence ended before, and the other numbers of
//                                            this step are 0; else 1
//
// Arrays of a rollout (on policy). The rows are the steps of one environment in order, then the
// steps of the next environment. Frames are not shifted, and next_obs_* are filled in only if
// `continues` is 0:
//
//   drawn_action     (B, A) f32          action before clipping
//   log_prob         (B) f32             log-probability of the drawn action under its policy
//   ends             (B) f32             1: last step of its episode; else 0
//   continues        (B) f32             1: the next row continues from this step; else 0
//   id               (B) u64             number of the environment
//
// Dimensions: B rows of the batch, K frames of a stack, C channels of a frame, (H, W) height and
// width, V floats of the observed blocks, P floats of the privileged blocks, A actions. Rows are
// the first dimension of all arrays. If the spec or the options have no pixels, no vectors or no
// privileged blocks, the batch has no array for them.
//
// If a new algorithm or sampler needs more arrays, add an option and its arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/spec/observation_spec.h"

namespace shoal {

enum class ArrayType : uint8_t { kU8, kF32, kU64 };

struct BatchArray {
  std::string name;
  ArrayType type = ArrayType::kF32;
  std::vector<int> shape{};  // shape of one row; empty = one number

  bool operator==(const BatchArray&) const = default;
};

// Options that, together with the spec, define the arrays of a batch and the meaning of their
// numbers.
struct BatchOptions {
  int batch = 1;               // B
  int copies = 1;              // consecutive elements made from one transition
  int target_shifts = 0;       // number of copies with their own shift of next_obs; 0 = all
  int critic_shifts = 0;       // number of copies with their own shift of obs; 0 = all
  int n_step = 1;              // n
  double discount = 1;         // discount between the n summed steps
  int horizon = 0;             // steps of the sequence of each sample; 0 = no sequences
  bool rollout = false;        // rows are steps in order, with the arrays of a rollout
  bool probabilities = false;  // with the probabilities of the samples
  // Privileged inputs: names of blocks that the policy does not observe, in any order.
  std::vector<std::string> privileged{};
};

struct BatchView;

class BatchSchema {
 public:
  BatchSchema(const ObservationSpec& spec, const BatchOptions& options);

  int batch() const { return options_.batch; }
  const BatchOptions& options() const { return options_; }
  std::span<const BatchArray> arrays() const { return arrays_; }
  bool Has(std::string_view name) const { return Find(name) < arrays_.size(); }
  // Size of all arrays together, with the padding between them; a multiple of 64.
  uint64_t total_bytes() const { return total_bytes_; }

  // Two schemas have the same hash if and only if their arrays and options are equal.
  uint64_t Hash() const;
  // Summary for messages: "batch 128, copies 1, n_step 1, discount 0.9: obs_frames u8 6x84x84, ...,
  // id u64".
  std::string Summary() const;

  // An array of the batch at `data`, which must have total_bytes() bytes, aligned to 64. Borrows
  // `data`. T is uint8_t, float or uint64_t. CHECKs that the array exists and has this type.
  template <class T>
  std::span<T> Array(std::string_view name, uint8_t* data) const;
  BatchView View(uint8_t* data, uint64_t stored_steps = 0) const;

 private:
  void AddStep(const ObservationSpec& spec, const std::string& prefix);
  void Add(const std::string& name, ArrayType type, std::vector<int> shape = {});
  // Position of the array in arrays_; arrays_.size() if there is no such array.
  size_t Find(std::string_view name) const;

  BatchOptions options_;
  std::vector<BatchArray> arrays_;
  std::vector<uint64_t> offsets_, sizes_;  // bytes, by array; sizes without padding
  uint64_t total_bytes_ = 0;
};

// One step of the sequences of a batch.
struct StepView {
  std::span<uint8_t> next_frames;
  std::span<float> next_vector, action, reward, terminated, present;
};

// View of a batch. The arrays that most algorithms use are members; a member is empty if the batch
// does not have the array. A view contains all rows of a batch or a range of rows. Borrows schema
// and memory.
struct BatchView {
  std::span<uint8_t> obs_frames, next_obs_frames;
  std::span<float> obs_vector, next_obs_vector, action, reward, bootstrap;
  std::span<float> obs_privileged, next_obs_privileged;
  std::span<uint64_t> weights_update, id;
  std::span<float> probability;
  std::span<float> drawn_action, log_prob, ends, continues;  // rollouts only
  std::vector<StepView> steps;                               // as many as BatchOptions::horizon
  uint64_t stored_steps = 0;  // the run's env steps when the batch was drawn, for schedules

  size_t rows() const { return reward.size(); }

  // The view's rows of the array with this name (see BatchSchema::Array).
  template <class T>
  std::span<T> Array(std::string_view name) const {
    const std::span<T> all = schema->Array<T>(name, data);
    const size_t row = all.size() / static_cast<size_t>(schema->batch());
    return all.subspan(first_row * row, rows() * row);
  }

  const BatchSchema* schema = nullptr;
  uint8_t* data = nullptr;
  size_t first_row = 0;  // first row of the view within the batch at `data`
};

// Calls visit(name, member) for each array of `view`. View is BatchView or const BatchView.
template <class View, class Visit>
void VisitArrays(View& view, Visit visit) {
  visit("obs_frames", view.obs_frames);
  visit("next_obs_frames", view.next_obs_frames);
  visit("obs_vector", view.obs_vector);
  visit("next_obs_vector", view.next_obs_vector);
  visit("obs_privileged", view.obs_privileged);
  visit("next_obs_privileged", view.next_obs_privileged);
  visit("action", view.action);
  visit("reward", view.reward);
  visit("bootstrap", view.bootstrap);
  visit("weights_update", view.weights_update);
  visit("id", view.id);
  visit("probability", view.probability);
  visit("drawn_action", view.drawn_action);
  visit("log_prob", view.log_prob);
  visit("ends", view.ends);
  visit("continues", view.continues);
  int h = 0;
  for (auto& step : view.steps) {
    const std::string prefix = "step" + std::to_string(++h) + ".";
    visit((prefix + "next_frames").c_str(), step.next_frames);
    visit((prefix + "next_vector").c_str(), step.next_vector);
    visit((prefix + "action").c_str(), step.action);
    visit((prefix + "reward").c_str(), step.reward);
    visit((prefix + "terminated").c_str(), step.terminated);
    visit((prefix + "present").c_str(), step.present);
  }
}

}  // namespace shoal

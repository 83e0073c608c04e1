// SPDX-License-Identifier: Apache-2.0
// Parameters that are trained together, in one array, so that an optimiser step is one pass; behind
// them the running statistics that belong to them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/nn/network_plan.h"
#include "common/nn/replica.h"
#include "common/nn/safetensors.h"

namespace shoal::nn {

class ParameterSet;
class SharedLayouts;  // laid_out_weight.h

// Address of the numbers of a parameter, row-major. Null: none yet.
struct PlainValues {
  const uint8_t* data = nullptr;
  bool bf16 = false;    // else f32
  bool aligned = true;  // to its type
};

// `count` numbers, to f32, which is exact.
void Widen(const PlainValues& from, int64_t count, float* to);

// One parameter of a set: row-major f32, unless it is borrowed. Borrows the set; copies refer to
// the same parameter.
class Parameter {
 public:
  Parameter() = default;
  Parameter(ParameterSet* set, int64_t offset, const ParameterSpec* spec)
      : set_(set), offset_(offset), spec_(spec) {}

  const std::vector<int64_t>& shape() const { return spec_->shape; }
  // Its numbers are in the tensors that were loaded last, not in the set.
  bool borrowed() const;
  // Moves with every optimiser step: fetch it when it is needed. Not of a borrowed one.
  float* value() const;
  // Values of any parameter, also of a borrowed one, whose address changes with every load.
  PlainValues plain() const;
  // Destination of an optimiser's step. The forward pass that measures a statistic writes the
  // statistic's next value here. Moves like value().
  float* next_value() const;
  // Stays. Null in a set without gradients, and of a statistic.
  float* gradient() const;

  // First float in the set's arrays.
  int64_t offset() const { return offset_; }
  const ParameterSet& set() const { return *set_; }

 private:
  ParameterSet* set_ = nullptr;
  int64_t offset_ = 0;
  const ParameterSpec* spec_ = nullptr;
};

// Owns gradients, values and a second array of values, into which an optimiser writes: exchanging
// the two applies its step, exchanging them again takes it back. Statistics lie behind what is
// trained: forward passes write them into the second array, so that a step and its undoing take
// them along. Not movable: layers borrow it.
//
// Each parameter starts at a multiple of 16 floats; the gaps hold zeros in all arrays. Those of
// several dimensions have no place in a set that borrows them.
//
// Replicas: the two arrays of values exist once, each replica's set refers to them. Which of the
// two holds the values is a property of each set, so that every replica exchanges its own. A
// replica writes only its share of the values, and all replicas meet before one reads them.
class ParameterSet {
 public:
  enum class Use {
    kTraining,
    kInference,  // no gradients, no second array
    kBorrowing,  // the same, for layers alone: values come by Borrow, and are not exported
  };

  // `replica`: borrowed while this constructs; null: alone.
  ParameterSet(std::vector<ParameterSpec> specs, Use use, Replica* replica = nullptr);
  ParameterSet(const ParameterSet&) = delete;
  ParameterSet& operator=(const ParameterSet&) = delete;

  // Sets each parameter by its Start. Its random stream is keyed by seed and name.
  void Initialise(uint64_t seed);

  const std::vector<ParameterSpec>& specs() const { return specs_; }
  bool Has(std::string_view name) const;
  // CHECKs that there is one.
  Parameter Find(std::string_view name);
  // Offset of the first parameter whose name starts with `prefix`; size() if there is none.
  int64_t OffsetOf(std::string_view prefix) const;

  int64_t size() const { return size_; }  // floats, gaps included
  // Without statistics: what gradients and optimisers have arrays of.
  int64_t trained_size() const { return trained_size_; }
  const float* values() const { return shared_->arrays[current_].data(); }
  float* values() { return shared_->arrays[current_].data(); }
  float* next_values() { return shared_->arrays[1 - current_].data(); }  // null: there are none
  const float* gradients() const { return gradients_.data(); }
  float* gradients() { return gradients_.data(); }
  void Exchange() { current_ = 1 - current_; }
  // Layouts of this set's weights that replicas share; null: alone.
  SharedLayouts* layouts() const { return shared_->layouts.get(); }
  int rank() const { return rank_; }  // of its replica

  // An array of this set's values to named tensors and back. `prefix` goes before each name.
  void Export(const float* array, const std::string& prefix, TensorMap* tensors) const;
  // The values under their own names.
  void Export(TensorMap* tensors) const { Export(values(), "", tensors); }
  // Takes F32 and BF16. Throws Error naming a missing tensor or a wrong type or shape; `array` is
  // then as it was.
  void Import(const TensorViews& tensors, const std::string& prefix, const std::string& source,
              float* array) const;
  // Takes and throws what Import does, for kBorrowing: values of one dimension are copied, the
  // others stay in `tensors`, whose bytes outlive the set or the next call.
  void Borrow(const TensorViews& tensors, const std::string& source);
  // The same for an array of what is trained alone (Adam's moments).
  void ExportTrained(const float* array, const std::string& prefix, TensorMap* tensors) const;
  void ImportTrained(const TensorViews& tensors, const std::string& prefix,
                     const std::string& source, float* array) const;

 private:
  friend class Parameter;

  void ExportFirst(size_t specs, const float* array, const std::string& prefix,
                   TensorMap* tensors) const;
  void ImportFirst(size_t specs, const TensorViews& tensors, const std::string& prefix,
                   const std::string& source, float* array) const;
  // State that exists once for all replicas.
  struct Shared {
    std::array<std::vector<float>, 2> arrays;  // values, and where a step writes
    std::shared_ptr<SharedLayouts> layouts;
  };
  std::shared_ptr<Shared> MakeShared(const Replica& replica) const;
  bool Borrows(const ParameterSpec& parameter) const;
  PlainValues& BorrowedOf(const ParameterSpec& parameter);

  const Use use_;
  std::vector<ParameterSpec> specs_;  // statistics last
  size_t trained_ = 0;                // specs that are no statistics
  int64_t size_ = 0, trained_size_ = 0;
  std::vector<int64_t> offsets_;
  const int rank_;
  std::shared_ptr<Shared> shared_;
  size_t current_ = 0;  // of the two arrays
  std::vector<float> gradients_;
  std::vector<PlainValues> borrowed_;  // one for each spec; empty unless kBorrowing
};

}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
// Parameters that are trained together. They are in one array, so that an optimiser step is one
// pass over this array. The running statistics follow the parameters in the array.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/nn/network_plan.h"
#include "common/nn/parameter_mirror.h"
#include "common/nn/pending_tensors.h"
#include "common/nn/replica.h"
#include "common/nn/safetensors.h"

namespace shoal::nn {

class ParameterSet;
class SharedLayouts;  // laid_out_weight.h

// Address of the values of a parameter, row-major.
struct PlainValues {
  const uint8_t* data = nullptr;  // null: no values yet
  bool bf16 = false;              // else f32
  bool aligned = true;            // whether the address is a multiple of the type's size
};

// Converts `count` numbers to f32, exactly.
void Widen(const PlainValues& from, int64_t count, float* to);

// One parameter of a set: row-major f32, unless it is borrowed. Borrows the set; copies refer to
// the same parameter.
class Parameter {
 public:
  Parameter() = default;
  Parameter(ParameterSet* set, int64_t offset, const ParameterSpec* spec)
      : set_(set), offset_(offset), spec_(spec) {}

  const std::vector<int64_t>& shape() const { return spec_->shape; }
  // Whether the parameter's values are in the tensors that were loaded last, not in the set.
  bool borrowed() const;
  // Address of the values, row-major. Every optimiser step changes the address, so do not store it.
  // Not for a borrowed parameter.
  float* value() const;
  // Values of any parameter, borrowed or not. The address of borrowed values changes with every
  // load.
  PlainValues plain() const;
  // Destination of an optimiser's step. A forward pass that measures a statistic writes the
  // statistic's next value here. The address changes like that of value().
  float* next_value() const;
  // Address of the gradient, which never changes. Null for a statistic and in a set without
  // gradients.
  float* gradient() const;

  // Index of its first float in the set's arrays.
  int64_t offset() const { return offset_; }
  const ParameterSet& set() const { return *set_; }

 private:
  ParameterSet* set_ = nullptr;
  int64_t offset_ = 0;
  const ParameterSpec* spec_ = nullptr;
};

// Owns gradients, values and a second array of values, into which an optimiser writes. Exchanging
// the two arrays applies the step; exchanging them again undoes the step. Statistics follow the
// trained parameters. Forward passes write statistics into the second array, so a step applies new
// statistics and an undo restores the old ones. Not movable, because layers borrow the set.
//
// Each parameter starts at a multiple of 16 floats; the gaps hold zeros in all arrays. The arrays
// of a set for borrowing contain only the parameters of one dimension.
//
// Replicas: the two arrays of values exist once, and each replica's set refers to them. Each set
// stores which of the two arrays holds the values, so every replica must call Exchange on its set.
// A replica writes only its share of the values. All replicas then pass a barrier before any of
// them reads the values.
class ParameterSet {
 public:
  enum class Use {
    kTraining,
    kInference,  // no gradients, no second array
    kBorrowing,  // like kInference, but Borrow sets the values; Initialise and Export are forbidden
  };

  // `replica`: borrowed during construction; null without replicas.
  ParameterSet(std::vector<ParameterSpec> specs, Use use, Replica* replica = nullptr);
  ParameterSet(const ParameterSet&) = delete;
  ParameterSet& operator=(const ParameterSet&) = delete;

  // Sets each parameter as its Start describes. The random stream of a parameter depends on `seed`
  // and on the parameter's name.
  void Initialise(uint64_t seed);

  const std::vector<ParameterSpec>& specs() const { return specs_; }
  bool Has(std::string_view name) const;
  // Returns the parameter `name`. CHECKs that it exists.
  Parameter Find(std::string_view name);
  // Offset of the first parameter whose name starts with `prefix`; size() if there is no such
  // parameter.
  int64_t OffsetOf(std::string_view prefix) const;

  // Offset of parameter number `spec` of specs().
  int64_t OffsetOf(size_t spec) const { return offsets_[spec]; }

  int64_t size() const { return size_; }  // number of floats, including gaps
  // Number of floats without statistics, which is the size of the arrays of gradients and
  // optimisers.
  int64_t trained_size() const { return trained_size_; }
  // The host's array. If the set has a mirror, these functions first fetch newer values from the
  // mirror, and the second one makes the mirror's values the older ones.
  const float* values() const {
    if (mirror_) FetchFromMirror();
    return shared_->arrays[current_].data();
  }
  float* values() {
    if (mirror_) MakeMirrorOld();
    return shared_->arrays[current_].data();
  }
  float* next_values() { return shared_->arrays[1 - current_].data(); }  // null: no second array
  const float* gradients() const { return gradients_.data(); }
  float* gradients() { return gradients_.data(); }
  void Exchange() { current_ = 1 - current_; }
  // Layouts of this set's weights that replicas share; null without replicas.
  SharedLayouts* layouts() const { return shared_->layouts.get(); }
  int rank() const { return rank_; }  // rank of its replica

  // For an engine that does not compute in host memory (parameter_mirror.h). Gradients, `Exchange`
  // and the second array of values are not used then. An engine attaches mirrors of its own to sets
  // that it gets as constants, because values do not change by that.
  void Attach(std::unique_ptr<ParameterMirror> mirror) const;
  // Null: no mirror.
  ParameterMirror* mirror() const { return mirror_.get(); }
  // Sends newer values of the host to the mirror. `changes`: the engine will change the mirror's
  // values. CHECKs that there is a mirror.
  void UseMirror(bool changes) const;

  // Writes an array of this set's values as named tensors; `prefix` precedes each name.
  void Export(const float* array, const std::string& prefix, TensorMap* tensors) const;
  // Exports the values under their own names.
  void Export(TensorMap* tensors) const { Export(values(), "", tensors); }
  // Does the same without waiting: if the mirror has newer values, begins a copy of them.
  void Export(PendingTensors* tensors) const;
  // Reads F32 and BF16 tensors into `array`. If a tensor is missing or has a wrong type or shape,
  // throws Error that names the tensor; `array` does not change then.
  void Import(const TensorViews& tensors, const std::string& prefix, const std::string& source,
              float* array) const;
  // Import for kBorrowing, with the same errors. Copies parameters of one dimension. The other
  // parameters stay in `tensors`, whose bytes must live until the next call or the end of the set.
  void Borrow(const TensorViews& tensors, const std::string& source);
  // Export and Import for an array without statistics (Adam's moments).
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
    std::array<std::vector<float>, 2> arrays;  // values, and destination of a step
    std::shared_ptr<SharedLayouts> layouts;
  };
  std::shared_ptr<Shared> MakeShared(const Replica& replica) const;
  bool Borrows(const ParameterSpec& parameter) const;
  void FetchFromMirror() const;
  void MakeMirrorOld();
  PlainValues& BorrowedOf(const ParameterSpec& parameter);

  const Use use_;
  std::vector<ParameterSpec> specs_;  // statistics last
  size_t trained_ = 0;                // number of specs that are not statistics
  int64_t size_ = 0, trained_size_ = 0;
  std::vector<int64_t> offsets_;
  const int rank_;
  std::shared_ptr<Shared> shared_;
  size_t current_ = 0;  // index of the array with the values
  std::vector<float> gradients_;
  std::vector<PlainValues> borrowed_;  // one for each spec; empty unless kBorrowing
  mutable std::unique_ptr<ParameterMirror> mirror_;
  // Whether the other copy has newer values.
  mutable bool host_is_old_ = false, mirror_is_old_ = false;
};

}  // namespace shoal::nn

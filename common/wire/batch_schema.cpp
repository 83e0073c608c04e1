// SPDX-License-Identifier: Apache-2.0
#include "common/wire/batch_schema.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <type_traits>
#include <utility>

#include "common/base/aligned_bytes.h"
#include "common/base/check.h"
#include "common/base/random.h"

namespace shoal {
namespace {

constexpr uint64_t kAlignment = AlignedBytes::kAlignment;

uint64_t BytesOf(ArrayType type) {
  switch (type) {
    case ArrayType::kU8:
      return 1;
    case ArrayType::kF32:
      return 4;
    case ArrayType::kU64:
      return 8;
  }
  CHECK(false) << static_cast<int>(type);
  return 0;
}

const char* NameOf(ArrayType type) {
  return type == ArrayType::kU8 ? "u8" : type == ArrayType::kF32 ? "f32" : "u64";
}

template <class T>
constexpr ArrayType TypeOf() {
  if constexpr (std::is_same_v<T, uint8_t>) return ArrayType::kU8;
  if constexpr (std::is_same_v<T, float>) return ArrayType::kF32;
  return ArrayType::kU64;
}

}  // namespace

BatchSchema::BatchSchema(const ObservationSpec& spec, const BatchOptions& options)
    : options_(options) {
  CHECK(options.batch > 0) << options.batch;
  // The arrays are added in the order of their bytes on the wire. Hash() covers this order.
  if (spec.HasPixels()) {
    const std::vector<int> input{spec.InputChannels(), spec.height, spec.width};
    Add("obs_frames", ArrayType::kU8, input);
    Add("next_obs_frames", ArrayType::kU8, input);
  }
  if (const int size = spec.VectorSize(); size > 0) {
    Add("obs_vector", ArrayType::kF32, {size});
    Add("next_obs_vector", ArrayType::kF32, {size});
  }
  if (!options.privileged.empty()) {
    const int size = BlockPicker::Named(spec, options.privileged).size();
    Add("obs_privileged", ArrayType::kF32, {size});
    Add("next_obs_privileged", ArrayType::kF32, {size});
  }
  Add("action", ArrayType::kF32, {spec.action_size});
  Add("reward", ArrayType::kF32);
  Add("bootstrap", ArrayType::kF32);
  Add("weights_update", ArrayType::kU64);
  Add("id", ArrayType::kU64);
  if (options.probabilities) Add("probability", ArrayType::kF32);
  for (int h = 1; h <= options.horizon; ++h) AddStep(spec, "step" + std::to_string(h) + ".");
  if (!options.rollout) return;
  Add("drawn_action", ArrayType::kF32, {spec.action_size});
  Add("log_prob", ArrayType::kF32);
  Add("ends", ArrayType::kF32);
  Add("continues", ArrayType::kF32);
}

void BatchSchema::AddStep(const ObservationSpec& spec, const std::string& prefix) {
  if (spec.HasPixels()) {
    Add(prefix + "next_frames", ArrayType::kU8, {spec.InputChannels(), spec.height, spec.width});
  }
  if (const int size = spec.VectorSize(); size > 0) {
    Add(prefix + "next_vector", ArrayType::kF32, {size});
  }
  Add(prefix + "action", ArrayType::kF32, {spec.action_size});
  for (const char* name : {"reward", "terminated", "present"}) {
    Add(prefix + name, ArrayType::kF32);
  }
}

void BatchSchema::Add(const std::string& name, ArrayType type, std::vector<int> shape) {
  CHECK(!Has(name)) << name;
  uint64_t bytes = static_cast<uint64_t>(options_.batch) * BytesOf(type);
  for (const int size : shape) bytes *= static_cast<uint64_t>(size);
  arrays_.push_back({name, type, std::move(shape)});
  offsets_.push_back(total_bytes_);
  sizes_.push_back(bytes);
  total_bytes_ += (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

size_t BatchSchema::Find(std::string_view name) const {
  size_t i = 0;
  while (i < arrays_.size() && arrays_[i].name != name) ++i;
  return i;
}

uint64_t BatchSchema::Hash() const {
  const std::string canonical = Summary();
  return HashBytes(canonical.data(), canonical.size());
}

std::string BatchSchema::Summary() const {
  std::string arrays;
  for (const BatchArray& array : arrays_) {
    arrays += fmt::format("{}{} {}", arrays.empty() ? "" : ", ", array.name, NameOf(array.type));
    if (!array.shape.empty()) arrays += fmt::format(" {}", fmt::join(array.shape, "x"));
  }
  const std::string privileged =
      options_.privileged.empty()
          ? ""
          : fmt::format(", privileged {}", fmt::join(options_.privileged, " "));
  const std::string shifts = options_.target_shifts == 0 && options_.critic_shifts == 0
                                 ? ""
                                 : fmt::format(" (shifts {} of next_obs, {} of obs; 0 = all)",
                                               options_.target_shifts, options_.critic_shifts);
  return fmt::format("batch {}, copies {}{}, n_step {}, discount {}{}: {}", options_.batch,
                     options_.copies, shifts, options_.n_step, options_.discount, privileged,
                     arrays);
}

template <class T>
std::span<T> BatchSchema::Array(std::string_view name, uint8_t* data) const {
  CHECK(reinterpret_cast<uintptr_t>(data) % kAlignment == 0);
  const size_t i = Find(name);
  CHECK(i < arrays_.size()) << "a batch has no array '" << name << "': " << Summary();
  CHECK(arrays_[i].type == TypeOf<T>()) << "array '" << name << "' is " << NameOf(arrays_[i].type);
  return {reinterpret_cast<T*>(data + offsets_[i]), static_cast<size_t>(sizes_[i]) / sizeof(T)};
}

template std::span<uint8_t> BatchSchema::Array(std::string_view, uint8_t*) const;
template std::span<float> BatchSchema::Array(std::string_view, uint8_t*) const;
template std::span<uint64_t> BatchSchema::Array(std::string_view, uint8_t*) const;

BatchView BatchSchema::View(uint8_t* data, uint64_t stored_steps) const {
  BatchView view;
  view.stored_steps = stored_steps;
  view.schema = this;
  view.data = data;
  view.steps.resize(static_cast<size_t>(options_.horizon));
  VisitArrays(view, [&]<class T>(const char* name, std::span<T>& member) {
    if (Has(name)) member = Array<T>(name, data);
  });
  return view;
}

}  // namespace shoal

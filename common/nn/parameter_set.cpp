// SPDX-License-Identifier: Apache-2.0
#include "common/nn/parameter_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "common/nn/bf16.h"
#include "common/nn/laid_out_weight.h"
#include "common/nn/orthogonal.h"

namespace shoal::nn {
namespace {

constexpr int64_t kAlignment = 16;  // floats

int64_t Count(const ParameterSpec& parameter) {
  int64_t count = 1;
  for (const int64_t size : parameter.shape) count *= size;
  return count;
}

std::string Shape(const std::vector<int64_t>& shape) {
  return shape.empty() ? "scalar" : fmt::format("{}", fmt::join(shape, "x"));
}

// The tensor of a parameter, with its shape and a type that Import takes. Throws Error otherwise.
const TensorView& Fitting(const ParameterSpec& parameter, const TensorViews& tensors,
                          const std::string& name, const std::string& source) {
  const TensorView* found = tensors.Find(name);
  if (found == nullptr) throw RuntimeError("{}: tensor {} is missing", source, name);
  const TensorView& tensor = *found;
  if (tensor.shape != parameter.shape) {
    throw RuntimeError("{}: tensor {} has shape {}, expected {}", source, name, Shape(tensor.shape),
                       Shape(parameter.shape));
  }
  if (tensor.dtype != "F32" && tensor.dtype != "BF16") {
    throw RuntimeError("{}: tensor {} is {}, expected F32 or BF16", source, name, tensor.dtype);
  }
  const size_t element = tensor.dtype == "BF16" ? sizeof(uint16_t) : sizeof(float);
  const size_t bytes = size_t(Count(parameter)) * element;
  if (tensor.data.size() != bytes) {
    throw RuntimeError("{}: tensor {} has {} bytes, expected {}", source, name, tensor.data.size(),
                       bytes);
  }
  return tensor;
}

void InitialiseOne(const ParameterSpec& parameter, uint64_t seed, float* values) {
  const int64_t count = Count(parameter);
  const double scale = parameter.start.scale;
  Random random(StreamKey(seed, StreamRole::kNetworkInit,
                          HashBytes(parameter.name.data(), parameter.name.size())));
  switch (parameter.start.kind) {
    case Start::Kind::kZeros:
      std::fill_n(values, count, 0.f);
      return;
    case Start::Kind::kOnes:
      std::fill_n(values, count, 1.f);
      return;
    case Start::Kind::kOrthogonal: {
      // The weights of each output are one row.
      const int64_t rows = parameter.shape[0];
      FillOrthogonal(rows, count / rows, scale, &random, values);
      return;
    }
    case Start::Kind::kUniform:
      std::generate_n(values, count, [&] { return float(random.Uniform(-scale, scale)); });
      return;
    case Start::Kind::kNormal:
      std::generate_n(values, count, [&] { return float(scale * random.Normal()); });
      return;
  }
}

PlainValues PlainOf(const TensorView& tensor) {
  const bool bf16 = tensor.dtype == "BF16";
  const auto address = reinterpret_cast<uintptr_t>(tensor.data.data());
  return {.data = tensor.data.data(),
          .bf16 = bf16,
          .aligned = address % (bf16 ? alignof(uint16_t) : alignof(float)) == 0};
}

}  // namespace

void Widen(const PlainValues& from, int64_t count, float* to) {
  if (!from.bf16) {
    std::memcpy(to, from.data, size_t(count) * sizeof(float));
  } else if (from.aligned) {
    Bf16ToFloats(reinterpret_cast<const uint16_t*>(from.data), count, to);
  } else {
    auto aligned = std::vector<uint16_t>(size_t(count));
    std::memcpy(aligned.data(), from.data, aligned.size() * sizeof(uint16_t));
    Bf16ToFloats(aligned.data(), count, to);
  }
}

bool Parameter::borrowed() const { return set_->Borrows(*spec_); }

float* Parameter::value() const {
  CHECK(!borrowed()) << spec_->name << " is borrowed from what was loaded";
  return set_->values() + offset_;
}

PlainValues Parameter::plain() const {
  if (borrowed()) return set_->BorrowedOf(*spec_);
  return {.data = reinterpret_cast<const uint8_t*>(value())};
}

float* Parameter::next_value() const {
  float* next = set_->next_values();
  return next == nullptr ? nullptr : next + offset_;
}

float* Parameter::gradient() const {
  if (set_->gradients_.empty() || spec_->statistic) return nullptr;
  return set_->gradients_.data() + offset_;
}

ParameterSet::ParameterSet(std::vector<ParameterSpec> specs, Use use, Replica* replica)
    : use_(use), specs_(std::move(specs)), rank_(replica == nullptr ? 0 : replica->rank()) {
  const auto statistics = std::stable_partition(
      specs_.begin(), specs_.end(), [](const ParameterSpec& spec) { return !spec.statistic; });
  trained_ = size_t(statistics - specs_.begin());
  for (const ParameterSpec& parameter : specs_) {
    offsets_.push_back(size_);
    if (Borrows(parameter)) continue;
    size_ += (Count(parameter) + kAlignment - 1) / kAlignment * kAlignment;
    if (!parameter.statistic) trained_size_ = size_;
  }
  shared_ = replica == nullptr ? MakeShared(Replica())
                               : replica->Shared<Shared>([&] { return MakeShared(*replica); });
  CHECK(int64_t(shared_->arrays[0].size()) == size_)
      << "another set than that of the first replica";
  if (use == Use::kBorrowing) borrowed_.resize(specs_.size());
  if (use == Use::kTraining) gradients_.assign(size_t(trained_size_), 0.f);
}

std::shared_ptr<ParameterSet::Shared> ParameterSet::MakeShared(const Replica& replica) const {
  auto shared = std::make_shared<Shared>();
  shared->arrays[0].assign(size_t(size_), 0.f);
  if (use_ == Use::kTraining) shared->arrays[1].assign(size_t(size_), 0.f);
  if (replica.count() > 1) {
    shared->layouts = std::make_shared<SharedLayouts>(replica.objects_shared());
  }
  return shared;
}

void ParameterSet::Attach(std::unique_ptr<ParameterMirror> mirror) const {
  CHECK(use_ != Use::kBorrowing && !mirror_);
  mirror_ = std::move(mirror);
  mirror_is_old_ = true;
}

void ParameterSet::UseMirror(bool changes) const {
  CHECK(mirror_);
  if (mirror_is_old_) mirror_->Send(shared_->arrays[current_].data());
  mirror_is_old_ = false;
  host_is_old_ = host_is_old_ || changes;
}

void ParameterSet::FetchFromMirror() const {
  if (host_is_old_) mirror_->Fetch(shared_->arrays[current_].data());
  host_is_old_ = false;
}

void ParameterSet::MakeMirrorOld() {
  FetchFromMirror();
  mirror_is_old_ = true;
}

bool ParameterSet::Borrows(const ParameterSpec& parameter) const {
  return use_ == Use::kBorrowing && parameter.shape.size() > 1;
}

PlainValues& ParameterSet::BorrowedOf(const ParameterSpec& parameter) {
  return borrowed_[size_t(&parameter - specs_.data())];
}

void ParameterSet::Initialise(uint64_t seed) {
  CHECK(use_ != Use::kBorrowing);
  for (size_t i = 0; i < specs_.size(); ++i) {
    InitialiseOne(specs_[i], seed, values() + offsets_[i]);
  }
}

bool ParameterSet::Has(std::string_view name) const {
  return std::any_of(specs_.begin(), specs_.end(),
                     [&](const ParameterSpec& parameter) { return parameter.name == name; });
}

Parameter ParameterSet::Find(std::string_view name) {
  for (size_t i = 0; i < specs_.size(); ++i) {
    if (specs_[i].name == name) return Parameter(this, offsets_[i], &specs_[i]);
  }
  CHECK(false) << "no parameter " << name;
  return {};
}

int64_t ParameterSet::OffsetOf(std::string_view prefix) const {
  for (size_t i = 0; i < specs_.size(); ++i) {
    if (specs_[i].name.starts_with(prefix)) return offsets_[i];
  }
  return size();
}

void ParameterSet::Export(const float* array, const std::string& prefix, TensorMap* tensors) const {
  ExportFirst(specs_.size(), array, prefix, tensors);
}

void ParameterSet::Export(PendingTensors* tensors) const {
  if (!host_is_old_) return Export(tensors->arrived());
  tensors->Add([this, read = mirror_->BeginFetch()](TensorMap* arrived) {
    auto fetched = std::vector<float>(size_t(size_));
    read(fetched.data());
    Export(fetched.data(), "", arrived);
  });
}

void ParameterSet::ExportTrained(const float* array, const std::string& prefix,
                                 TensorMap* tensors) const {
  ExportFirst(trained_, array, prefix, tensors);
}

void ParameterSet::Import(const TensorViews& tensors, const std::string& prefix,
                          const std::string& source, float* array) const {
  ImportFirst(specs_.size(), tensors, prefix, source, array);
}

void ParameterSet::ImportTrained(const TensorViews& tensors, const std::string& prefix,
                                 const std::string& source, float* array) const {
  ImportFirst(trained_, tensors, prefix, source, array);
}

void ParameterSet::ExportFirst(size_t specs, const float* array, const std::string& prefix,
                               TensorMap* tensors) const {
  CHECK(use_ != Use::kBorrowing);
  for (size_t i = 0; i < specs; ++i) {
    const auto* first = reinterpret_cast<const uint8_t*>(array + offsets_[i]);
    (*tensors)[prefix + specs_[i].name] = {
        "F32", specs_[i].shape, {first, first + size_t(Count(specs_[i])) * sizeof(float)}};
  }
}

void ParameterSet::ImportFirst(size_t specs, const TensorViews& tensors, const std::string& prefix,
                               const std::string& source, float* array) const {
  CHECK(use_ != Use::kBorrowing);
  // Every tensor is checked before the first is written, so that an error changes nothing.
  std::vector<const TensorView*> found;
  for (size_t i = 0; i < specs; ++i) {
    found.push_back(&Fitting(specs_[i], tensors, prefix + specs_[i].name, source));
  }
  for (size_t i = 0; i < specs; ++i) {
    Widen(PlainOf(*found[i]), Count(specs_[i]), array + offsets_[i]);
  }
}

void ParameterSet::Borrow(const TensorViews& tensors, const std::string& source) {
  CHECK(use_ == Use::kBorrowing);
  std::vector<PlainValues> found;
  for (const ParameterSpec& parameter : specs_) {
    found.push_back(PlainOf(Fitting(parameter, tensors, parameter.name, source)));
  }
  for (size_t i = 0; i < specs_.size(); ++i) {
    if (!Borrows(specs_[i])) Widen(found[i], Count(specs_[i]), values() + offsets_[i]);
  }
  borrowed_ = std::move(found);
}

}  // namespace shoal::nn

// SPDX-License-Identifier: Apache-2.0
#include "learner/device/device_parameters.h"

#include "common/base/check.h"
#include "common/nn/bf16.h"

namespace shoal::learner::device {
namespace {

// Copies in the order of the commands, and waits.
void CopyInNow(Device* device, const void* host, int64_t bytes, void* to) {
  device->CopyIn(Lane::kCommands, host, bytes, to);
  device->Finish();
}
void CopyOutNow(Device* device, const void* from, int64_t bytes, void* host) {
  device->CopyOut(Lane::kCommands, from, bytes, host);
  device->Finish();
}

int64_t SumBlocks(const nn::Adam& optimiser) {
  int64_t blocks = 0;
  for (const nn::ParameterSet* set : optimiser.sets()) {
    blocks += kernels::BlocksForElements(DeviceParameters::Of(*set).layout().trained_size());
  }
  return blocks;
}

int64_t Bytes(const std::vector<float>& values) { return int64_t(values.size() * sizeof(float)); }

}  // namespace

DeviceParameters::DeviceParameters(Workspace* workspace, const ParameterLayout& layout,
                                   bool trained)
    : workspace_(workspace),
      layout_(layout),
      values_(workspace->New<float>(layout.size())),
      rounded_(workspace->compute_type() == Type::kBf16 ? workspace->New<uint16_t>(layout.size())
                                                        : nullptr),
      gradients_(trained ? workspace->New<float>(layout.trained_size()) : nullptr),
      next_statistics_(trained ? workspace->New<float>(layout.size() - layout.trained_size())
                               : nullptr) {}

DeviceParameters& DeviceParameters::Of(const nn::ParameterSet& set) {
  auto* mirror = dynamic_cast<DeviceParameters*>(set.mirror());
  CHECK(mirror != nullptr) << "parameters of another engine";
  return *mirror;
}

DeviceParameters& DeviceParameters::Attach(Workspace* workspace, const ParameterLayout& layout,
                                           nn::ParameterSet::Use use, const nn::ParameterSet& set) {
  set.Attach(std::make_unique<DeviceParameters>(workspace, layout,
                                                use == nn::ParameterSet::Use::kTraining));
  return Of(set);
}

std::function<void(float* values)> DeviceParameters::BeginFetch() {
  const int64_t bytes = layout_.size() * int64_t(sizeof(float));
  return [this, copy = workspace_->host_copies().Begin(values_, bytes)](float* values) {
    layout_.ToHost(static_cast<const float*>(copy->Wait()), /*statistics=*/true, values);
  };
}

void DeviceParameters::Send(const float* values) {
  std::vector<float> ordered(size_t(layout_.size()));
  layout_.ToDevice(values, /*statistics=*/true, ordered.data());
  CopyInNow(workspace_->device(), ordered.data(), Bytes(ordered), values_);
  if (rounded_ == nullptr) return;
  std::vector<uint16_t> rounded(ordered.size());
  nn::FloatsToBf16(ordered.data(), layout_.size(), rounded.data());
  CopyInNow(workspace_->device(), rounded.data(), int64_t(rounded.size() * sizeof(uint16_t)),
            rounded_);
}

Tensor DeviceParameters::Find(const std::string& name) const {
  const int64_t offset = layout_.OffsetOf(name), statistic = offset - layout_.trained_size();
  const auto at = [](auto* array, int64_t of) { return array == nullptr ? nullptr : array + of; };
  return {.value = values_ + offset,
          .rounded = at(rounded_, offset),
          .gradient = statistic < 0 ? at(gradients_, offset) : nullptr,
          .next_value = statistic < 0 ? nullptr : at(next_statistics_, statistic)};
}

DeviceAdam::DeviceAdam(Workspace* workspace, const nn::Adam& optimiser)
    : partials(workspace->New<double>(SumBlocks(optimiser))),
      workspace_(workspace),
      state_(workspace->New<kernels::AdamState>(1)) {
  for (const nn::ParameterSet* set : optimiser.sets()) {
    const DeviceParameters& parameters = DeviceParameters::Of(*set);
    const int64_t trained = parameters.layout().trained_size();
    sets_.push_back(&parameters);
    const auto zeros = [&](int64_t size) { return workspace->New<float>(size); };
    arrays_.push_back({.m = zeros(trained),
                       .v = zeros(trained),
                       .former_value = zeros(parameters.layout().size()),
                       .former_m = zeros(trained),
                       .former_v = zeros(trained)});
  }
}

DeviceAdam& DeviceAdam::Of(const nn::Adam& optimiser) {
  auto* mirror = dynamic_cast<DeviceAdam*>(optimiser.mirror());
  CHECK(mirror != nullptr) << "optimiser of another engine";
  return *mirror;
}

uint64_t DeviceAdam::Fetch(std::span<const Moments> sets) {
  Device* const device = workspace_->device();
  for (size_t i = 0; i < sets.size(); ++i) {
    const ParameterLayout& layout = sets_[i]->layout();
    std::vector<float> ordered(size_t(layout.trained_size()));
    CopyOutNow(device, arrays_[i].m, Bytes(ordered), ordered.data());
    layout.ToHost(ordered.data(), /*statistics=*/false, sets[i].m);
    CopyOutNow(device, arrays_[i].v, Bytes(ordered), ordered.data());
    layout.ToHost(ordered.data(), /*statistics=*/false, sets[i].v);
  }
  kernels::AdamState state;
  CopyOutNow(device, state_, sizeof(state), &state);
  return uint64_t(state.steps);
}

void DeviceAdam::Send(std::span<const Moments> sets, uint64_t steps) {
  Device* const device = workspace_->device();
  for (size_t i = 0; i < sets.size(); ++i) {
    const ParameterLayout& layout = sets_[i]->layout();
    std::vector<float> ordered(size_t(layout.trained_size()));
    layout.ToDevice(sets[i].m, /*statistics=*/false, ordered.data());
    CopyInNow(device, ordered.data(), Bytes(ordered), arrays_[i].m);
    layout.ToDevice(sets[i].v, /*statistics=*/false, ordered.data());
    CopyInNow(device, ordered.data(), Bytes(ordered), arrays_[i].v);
  }
  const kernels::AdamState state{.steps = int64_t(steps), .taken = 0};
  CopyInNow(device, &state, sizeof(state), state_);
}

}  // namespace shoal::learner::device

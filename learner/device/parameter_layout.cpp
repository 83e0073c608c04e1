// SPDX-License-Identifier: Apache-2.0
#include "learner/device/parameter_layout.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::learner::device {
namespace {

constexpr int64_t kParameterAlignment = 64;  // numbers

// Calls copy(device index, host index) for each number of a parameter.
template <class Copy>
void ForEach(const ParameterOrder& order, const Copy& copy) {
  for (int64_t o = 0; o < order.outer; ++o) {
    for (int64_t p = 0; p < order.pixels; ++p) {
      for (int64_t c = 0; c < order.channels; ++c) {
        copy((o * order.pixels + p) * order.padded_channels + c,
             (o * order.channels + c) * order.pixels + p);
      }
    }
  }
}

}  // namespace

ParameterLayout::ParameterLayout(const nn::ParameterSet& set) {
  for (size_t i = 0; i < set.specs().size(); ++i) {
    const nn::ParameterSpec& spec = set.specs()[i];
    int64_t count = 1;
    for (const int64_t size : spec.shape) count *= size;
    places_.push_back({.name = spec.name,
                       .host_offset = set.OffsetOf(i),
                       .offset = 0,
                       .statistic = spec.statistic,
                       .order = {.outer = count, .padded_outer = count}});
  }
  SetOffsets();
}

void ParameterLayout::SetOffsets() {
  size_ = trained_size_ = 0;
  for (Place& place : places_) {
    place.offset = size_;
    size_ +=
        (place.order.size() + kParameterAlignment - 1) / kParameterAlignment * kParameterAlignment;
    if (!place.statistic) trained_size_ = size_;
  }
}

size_t ParameterLayout::IndexOf(const std::string& name) const {
  const auto found = std::ranges::find(places_, name, &Place::name);
  CHECK(found != places_.end()) << "no parameter " << name;
  return size_t(found - places_.begin());
}

void ParameterLayout::Set(const std::string& name, const ParameterOrder& order) {
  Place& place = places_[IndexOf(name)];
  CHECK(place.order.host_size() == order.host_size()) << name;
  place.order = order;
  SetOffsets();
}

int64_t ParameterLayout::OffsetOf(const std::string& name) const {
  return places_[IndexOf(name)].offset;
}

void ParameterLayout::ToDevice(const float* host, bool statistics, float* device) const {
  std::fill_n(device, statistics ? size_ : trained_size_, 0.f);
  for (const Place& place : places_) {
    if (place.statistic && !statistics) continue;
    ForEach(place.order, [&](int64_t to, int64_t from) {
      device[place.offset + to] = host[place.host_offset + from];
    });
  }
}

void ParameterLayout::ToHost(const float* device, bool statistics, float* host) const {
  for (const Place& place : places_) {
    if (place.statistic && !statistics) continue;
    ForEach(place.order, [&](int64_t from, int64_t to) {
      host[place.host_offset + to] = device[place.offset + from];
    });
  }
}

}  // namespace shoal::learner::device

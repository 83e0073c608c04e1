// SPDX-License-Identifier: Apache-2.0
// Order of a parameter set's numbers in the memory of a device.
//
// The host stores weights of a convolution as (N, C, k, k). A device stores them as (N, k, k, C),
// with padding where it needs multiples of channels. The columns of a trunk's weights, one for each
// number of a feature map, have the order of the map: (C, h, w) on the host, (h, w, C) on the
// device. Each parameter begins at a multiple of 64 numbers. Padding and gaps hold 0.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/nn/parameter_set.h"

namespace shoal::learner::device {

// Order of one parameter (outer, channels, pixels) of the host:
//
//   device[(o pixels + p) padded_channels + c] = host[(o channels + c) pixels + p]
struct ParameterOrder {
  int64_t outer = 1, padded_outer = 1;
  int64_t channels = 1, padded_channels = 1;
  int64_t pixels = 1;

  int64_t host_size() const { return outer * channels * pixels; }
  int64_t size() const { return padded_outer * padded_channels * pixels; }
};

class ParameterLayout {
 public:
  // The host's order without padding. The layout does not keep a reference to the set.
  explicit ParameterLayout(const nn::ParameterSet& set);

  // Sets the order of parameter `name`, which must have as many numbers on the host.
  void Set(const std::string& name, const ParameterOrder& order);

  int64_t size() const { return size_; }
  int64_t trained_size() const { return trained_size_; }  // without statistics, which are last
  // Offset of parameter `name`. CHECKs that it exists.
  int64_t OffsetOf(const std::string& name) const;

  // Copies numbers of all parameters, or without statistics, between an array of the host, in the
  // layout of the set, and an array in this layout.
  void ToDevice(const float* host, bool statistics, float* device) const;
  void ToHost(const float* device, bool statistics, float* host) const;

 private:
  struct Place {
    std::string name;
    int64_t host_offset, offset;
    bool statistic;
    ParameterOrder order;
  };

  size_t IndexOf(const std::string& name) const;
  void SetOffsets();

  std::vector<Place> places_;
  int64_t size_ = 0, trained_size_ = 0;
};

}  // namespace shoal::learner::device

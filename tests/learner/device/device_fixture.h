// SPDX-License-Identifier: Apache-2.0
// Agents that compute with a device in host memory, beside agents of the CPU's engine.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <span>
#include <string>

#include "learner/device/device_engine.h"
#include "learner/device/host_device.h"
#include "learner/engine/cpu_engine.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner::device {

struct AgentCase {
  std::string name;
  std::function<void(Config*, ObservationSpec*)> set;
  uint64_t updates = 200;  // after which networks are compared
  // End of the names of parameters that change no result. Their gradients are rounding errors,
  // which Adam's steps enlarge, so they are not compared.
  std::string without_effect = {};
};

inline void PrintTo(const AgentCase& each, std::ostream* out) { *out << each.name; }

inline void WithoutPixels(ObservationSpec* spec) {
  spec->cameras.clear();
  spec->channels = spec->height = spec->width = 0;
  spec->stack = 1;
}

// Maps and weights have padding, as on a card.
inline constexpr HostDevice::Options kPadding{.f32_channels = 4, .bf16_channels = 8};

// An agent with an engine on a device in host memory.
struct OnDevice {
  OnDevice(const Config& config, const ObservationSpec& spec, nn::Precision precision,
           int in_flight = 0, const HostDevice::Options& options = kPadding)
      : device(options),
        engine(&device, precision, config.learner.batch, in_flight),
        agent(FindAlgorithm(config.learner.algorithm).make(config, spec, &engine)) {}

  HostDevice device;
  DeviceEngine engine;
  std::unique_ptr<Agent> agent;
};

struct OnCpu {
  OnCpu(const Config& config, const ObservationSpec& spec, nn::Precision precision)
      : engine(precision, config.learner.batch, &alone),
        agent(FindAlgorithm(config.learner.algorithm).make(config, spec, &engine)) {}

  nn::Replica alone;
  CpuEngine engine;
  std::unique_ptr<Agent> agent;
};

// Euclidean distance of two tensors or more, relative to the length of the second ones.
struct Distance {
  double squares = 0, length = 0;

  void Add(std::span<const float> some, std::span<const float> other) {
    const float *a = some.data(), *b = other.data();
    for (size_t i = 0; i < other.size(); ++i) {
      const double difference = double(a[i]) - double(b[i]);
      squares += difference * difference;
      length += double(b[i]) * double(b[i]);
    }
  }
  double Relative() const { return std::sqrt(squares / std::max(length, 1e-12)); }
};

// The network that a tensor belongs to, with its moments apart: "actor", "adam.m.actor".
inline std::string NetworkOf(const std::string& name) {
  const size_t first = name.starts_with("adam.") ? std::string("adam.m.").size() : 0;
  return name.substr(0, name.find('.', first));
}

// Expects equal shapes and equal counters, and networks within the tolerance. `moments`: the
// tolerance of an optimiser's moments; 0: not compared. without_effect: see AgentCase.
inline void ExpectNear(const nn::TensorMap& some, const nn::TensorMap& other, double tolerance,
                       double moments, const std::string& without_effect = {}) {
  ASSERT_EQ(some.size(), other.size());
  std::map<std::string, Distance> networks;
  for (const auto& [name, tensor] : other) {
    ASSERT_TRUE(some.contains(name)) << name;
    ASSERT_EQ(some.at(name).shape, tensor.shape) << name;
    if (!without_effect.empty() && name.ends_with(without_effect)) continue;
    if (tensor.dtype == "F32") {
      networks[NetworkOf(name)].Add(Floats(some, name), Floats(other, name));
    } else if (!name.ends_with(".moments")) {
      EXPECT_EQ(some.at(name).data, tensor.data) << name;
    }
  }
  for (const auto& [name, distance] : networks) {
    const bool is_moments = name.starts_with("adam.");
    if (is_moments && moments == 0) continue;
    EXPECT_LT(distance.Relative(), is_moments ? moments : tolerance) << name;
  }
}

// Expects the same figures in the same order.
inline void ExpectFigures(const UpdateOutcome& outcome, const UpdateOutcome& expected,
                          double tolerance) {
  const auto &some = outcome.figures.entries(), &other = expected.figures.entries();
  ASSERT_EQ(some.size(), other.size());
  for (size_t i = 0; i < some.size(); ++i) {
    ASSERT_EQ(some[i].figure, other[i].figure);
    EXPECT_NEAR(some[i].value, other[i].value, tolerance * (1 + std::abs(other[i].value)))
        << some[i].figure->name;
  }
}

}  // namespace shoal::learner::device

// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "learner/agent/algorithms.h"
#include "learner/device/device_agent.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/cuda/trial.h"

namespace shoal::trial {
namespace {

using learner::device::Device;
using learner::device::MakeDeviceAgent;

constexpr double kF32Drift = 1e-3, kBf16Drift = 2e-2, kPpoDrift = 5e-3;

struct Setting {
  std::string algorithm, encoder;  // encoder "" = vectors only
  nn::Precision precision;
};

bool OnPolicy(const Setting& setting) { return setting.algorithm == "ppo"; }

// An update on policy has as many minibatches as kEpochs passes over kMinibatches of them.
constexpr int kEpochs = 2, kMinibatches = 2;
BatchOptions OptionsOf(const Setting& setting, int batch) {
  if (!OnPolicy(setting)) return {.batch = batch};
  return {.batch = kMinibatches * batch, .rollout = true};
}

Config ConfigOf(const Setting& setting, int batch) {
  Config config;
  config.learner.algorithm = setting.algorithm;
  config.learner.batch = batch;
  config.ppo.epochs = kEpochs;
  config.observation.pixels = !setting.encoder.empty();
  if (!setting.encoder.empty()) config.network.encoder = setting.encoder;
  return config;
}

ObservationSpec SpecOf(const Setting& setting) {
  ObservationSpec spec = bench::PixelSpec();
  spec.drawn_actions = OnPolicy(setting);
  if (!setting.encoder.empty()) return spec;
  spec.cameras.clear();
  spec.channels = 0;
  spec.blocks = {{"state", 10}};
  return spec;
}

float FloatAt(const nn::NamedTensor& tensor, size_t byte) {
  float value;
  std::memcpy(&value, &tensor.data.at(byte), sizeof(value));
  return value;
}

// The bias before a spatial softmax changes no point. Its gradient is a rounding error, which
// Adam's steps enlarge.
constexpr std::string_view kWithoutEffect = "encoder.conv1.bias";

// The tensor whose values differ most, by the Euclidean norm of the difference relative to that of
// the tensor. Leaves out `without_effect`.
double ParameterDifference(const nn::TensorMap& a, const nn::TensorMap& b,
                           std::string_view without_effect) {
  double worst = 0;
  for (const auto& [name, tensor] : a) {
    if (name == without_effect) continue;
    const auto other = b.find(name);
    if (other == b.end()) return std::numeric_limits<double>::infinity();
    double difference = 0, norm = 0;
    for (size_t i = 0; i + sizeof(float) <= tensor.data.size(); i += sizeof(float)) {
      const double x = FloatAt(tensor, i), y = FloatAt(other->second, i);
      difference += (x - y) * (x - y);
      norm += y * y;
    }
    worst = std::max(worst, std::sqrt(difference) / std::max(std::sqrt(norm), 1e-6));
    if (!std::isfinite(difference)) return std::numeric_limits<double>::infinity();
  }
  return worst;
}

void TryUpdatesOf(Device* device, const Setting& setting, int updates, int batch,
                  const Trials& trials) {
  const bool f32 = setting.precision == nn::Precision::kF32;
  const double limit = OnPolicy(setting) ? kPpoDrift : f32 ? kF32Drift : kBf16Drift;
  const std::string name =
      fmt::format("{} {} of {}, {}, {}", updates, OnPolicy(setting) ? "minibatches" : "updates",
                  setting.algorithm, setting.encoder.empty() ? "vectors" : setting.encoder,
                  nn::ToString(setting.precision));
  trials.TryError(name, "relative difference", limit, [&] {
    const Config config = ConfigOf(setting, batch);
    const ObservationSpec spec = SpecOf(setting);
    const bench::NoiseBatch noise(spec, OptionsOf(setting, batch));
    const auto ours = MakeDeviceAgent(config, spec, setting.precision, device);
    const auto theirs = learner::MakeAgent(config, spec, setting.precision);
    const int steps = OnPolicy(setting) ? kEpochs * kMinibatches : 1;  // of an update
    for (int i = 0; i < updates; i += steps) {
      ours->Submit(noise.batch, [](learner::UpdateStage) {});
      theirs->Update(noise.batch);
    }
    ours->Finish();
    return ParameterDifference(ours->PolicyTensors(), theirs->PolicyTensors(),
                               setting.encoder == "spatial_softmax" ? kWithoutEffect : "");
  });
}

// Losses and norms of gradients of one update, for a network whose later updates differ by
// rounding: each ReLU that rounding switches changes a gradient, and Adam's first steps have the
// size of the rate whatever the size of a gradient.
void TryFirstUpdateOf(Device* device, const Setting& setting, int batch, const Trials& trials) {
  const std::string name = fmt::format("first figures of {}, {}, {}", setting.algorithm,
                                       setting.encoder, nn::ToString(setting.precision));
  trials.TryError(name, "relative difference", kF32Drift, [&] {
    const Config config = ConfigOf(setting, batch);
    const ObservationSpec spec = SpecOf(setting);
    const bench::NoiseBatch noise(config, spec);
    const auto outcome =
        MakeDeviceAgent(config, spec, setting.precision, device)->Update(noise.batch);
    const auto expected = learner::MakeAgent(config, spec, setting.precision)->Update(noise.batch);
    const auto &some = outcome.figures.entries(), &other = expected.figures.entries();
    double worst = some.size() == other.size() ? 0 : std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < std::min(some.size(), other.size()); ++i) {
      const double difference = std::abs(some[i].value - other[i].value);
      worst = std::max(worst, difference / (1 + std::abs(other[i].value)));
    }
    return worst;
  });
}

// Calls `step` for this time, then `finish`; returns calls per second.
double RateOf(double seconds, const std::function<void()>& step,
              const std::function<void()>& finish) {
  int steps = 0;
  const SteadyTime start = Now();
  while (SecondsSince(start) < seconds) {
    step();
    ++steps;
  }
  finish();
  return steps / SecondsSince(start);
}

// Pins a batch while this object exists, as the learner does with the replay's batches.
class Pinned {
 public:
  Pinned(Device* device, const bench::NoiseBatch& noise)
      : device_(device), memory_(noise.memory.data()) {
    if (!device_->RegisterHost(memory_, int64_t(noise.schema.total_bytes()))) {
      throw DeviceError("{} cannot pin memory", device_->info().name);
    }
  }
  ~Pinned() {
    try {
      device_->UnregisterHost(memory_);
    } catch (const Error&) {  // of a lost GPU
    }
  }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  Device* const device_;
  const uint8_t* const memory_;
};

void TimeUpdatesOf(Device* device, const std::string& encoder, int batch, double seconds,
                   std::optional<double> least, const Trials& trials, int width = 256) {
  const std::string name = fmt::format("SAC update, {}, MLP of {}, batch {}, bf16, batches copied",
                                       encoder, width, batch);
  trials.TryRate(name, "updates/s", least, [&] {
    const Setting setting{
        .algorithm = "sac", .encoder = encoder, .precision = nn::Precision::kBf16};
    Config config = ConfigOf(setting, batch);
    config.network.hidden = {width, width};
    const ObservationSpec spec = SpecOf(setting);
    const bench::NoiseBatch noise(config, spec);
    const Pinned pinned(device, noise);
    const auto agent = MakeDeviceAgent(config, spec, setting.precision, device);
    const auto step = [&] { agent->Submit(noise.batch, [](learner::UpdateStage) {}); };
    const auto finish = [&] { agent->Finish(); };
    RateOf(seconds / 3, step, finish);  // the first updates are recorded
    return RateOf(seconds, step, finish);
  });
}

// Copies of a batch to the device, from pinned memory or not.
void TimeCopies(Device* device, bool pins, double seconds, const Trials& trials) {
  trials.TryRate(fmt::format("copies of batches, {}", pins ? "pinned" : "not pinned"), "GB/s",
                 std::nullopt, [&] {
                   const Setting setting{
                       .algorithm = "sac", .encoder = "compact", .precision = nn::Precision::kBf16};
                   const Config config = ConfigOf(setting, 128);
                   const bench::NoiseBatch noise(config, SpecOf(setting));
                   std::optional<Pinned> pinned;
                   if (pins) pinned.emplace(device, noise);
                   const auto bytes = int64_t(noise.schema.total_bytes());
                   void* const memory = device->Allocate(bytes);
                   const double rate = RateOf(
                       seconds,
                       [&] {
                         device->CopyIn(learner::device::Lane::kCopies, noise.memory.data(), bytes,
                                        memory);
                         device->Finish();
                       },
                       [] {});
                   device->Free(memory);
                   return rate * double(bytes) * 1e-9;
                 });
}

}  // namespace

void TryUpdates(Device* device, bool quick, const Trials& trials) {
  if (quick) {
    TryUpdatesOf(device, {"sac", "", nn::Precision::kF32}, 5, 8, trials);
    TryUpdatesOf(device, {"ppo", "", nn::Precision::kF32}, kEpochs * kMinibatches, 8, trials);
    return;
  }
  for (const char* algorithm : {"sac", "td3", "ddpg"}) {
    for (const char* encoder : {"", "compact", "drq", "nature", "spatial_softmax"}) {
      TryUpdatesOf(device, {algorithm, encoder, nn::Precision::kF32}, 200, 16, trials);
    }
  }
  // The ratios of PPO change with each step, and a ReLU that rounding switches in one of the
  // engines changes their gradients by a part in a thousand. Later minibatches enlarge the
  // difference.
  for (const char* encoder : {"", "compact", "drq", "nature", "spatial_softmax"}) {
    const int minibatches = *encoder == '\0' ? 40 : kEpochs * kMinibatches;
    TryUpdatesOf(device, {"ppo", encoder, nn::Precision::kF32}, minibatches, 16, trials);
  }
  // The CPU takes up to half a second for an update of these.
  TryUpdatesOf(device, {"sac", "alexnet", nn::Precision::kF32}, 5, 16, trials);
  TryFirstUpdateOf(device, {"td3", "resnet18", nn::Precision::kF32}, 16, trials);
  // The CPU's engine needs a CPU with bf16.
  if (nn::ChoosePrecision("auto", /*pixels=*/true) == nn::Precision::kBf16) {
    TryUpdatesOf(device, {"sac", "compact", nn::Precision::kBf16}, 200, 16, trials);
  }
}

void TimeUpdates(Device* device, bool quick, double seconds, const Trials& trials) {
  if (quick) {
    TimeUpdatesOf(device, "compact", 2, 0.1, std::nullopt, trials);
    return;
  }
  TimeCopies(device, /*pins=*/true, seconds / 3, trials);
  TimeCopies(device, /*pins=*/false, seconds / 3, trials);
  // The least rates are those of PyTorch on an H100 (docs/notes/learner-on-a-gpu.md).
  TimeUpdatesOf(device, "compact", 128, seconds, 1055, trials);
  TimeUpdatesOf(device, "drq", 256, seconds, 404, trials, /*width=*/1024);
  TimeUpdatesOf(device, "compact", 512, seconds, std::nullopt, trials);
  TimeUpdatesOf(device, "nature", 256, seconds, std::nullopt, trials);
  TimeUpdatesOf(device, "spatial_softmax", 128, seconds, std::nullopt, trials);
  TimeUpdatesOf(device, "alexnet", 128, seconds, std::nullopt, trials);
  TimeUpdatesOf(device, "resnet18", 128, seconds, std::nullopt, trials);
}

}  // namespace shoal::trial

// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <functional>
#include <optional>
#include <string>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "learner/device/device_agent.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/cuda/agent_comparison.h"
#include "tests/cuda/trial.h"

namespace shoal::trial {
namespace {

using learner::device::Device;
using learner::device::MakeDeviceAgent;

// Limits of an agent's differences. docs/notes/rounding-of-updates.md says how large rounding makes
// them. The median finds faults of each update, and the largest difference finds grave faults of a
// few updates.
struct Limits {
  double figures, median, largest;
};
constexpr Limits kVectors{1e-4, 1e-3, 0.5};
constexpr Limits kPixels{1e-4, 3e-3, 0.5};
// The figures of a rollout are means of several updates.
constexpr Limits kRollouts{5e-3, 3e-3, 0.5};
// Many gradients of these deep networks are nearly 0, and Adam's first steps enlarge them.
constexpr Limits kDeep{1e-3, 5e-2, 0.5};
constexpr Limits kBf16{2e-2, 0.1, 0.8};

void TryUpdatesOf(Device* device, const Setting& setting, const Schedule& schedule,
                  const Limits& limits, const Trials& trials) {
  std::optional<Differences> made;
  const auto differences = [&]() -> const Differences& {
    if (!made) made = CompareUpdates(device, setting, schedule);
    return *made;
  };
  const std::string name = Describe(setting);
  const bool rollouts = setting.algorithm == "ppo";
  const std::string changes =
      fmt::format("{}: change in {} {}{}", name, schedule.stretch, rollouts ? "rollout" : "update",
                  schedule.stretch == 1 ? "" : "s");
  const int stretches = (schedule.updates + schedule.every - 1) / schedule.every;
  const char* const unit = "relative difference";
  trials.TryError(name + ": figures of the first update", unit, limits.figures,
                  [&] { return differences().figures; });
  trials.TryError(fmt::format("{}, median of {}", changes, stretches), unit, limits.median,
                  [&] { return differences().MedianChange(); });
  trials.TryError(fmt::format("{}, largest of {}", changes, stretches), unit, limits.largest,
                  [&] { return differences().LargestChange(); });
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

void TryUpdates(const UpdateTrials& what, const Trials& trials) {
  constexpr auto kSingle = nn::Precision::kF32;
  const auto make = [&](const Setting& setting, Schedule schedule, const Limits& limits) {
    if (what.stretch > 0) schedule.every = schedule.stretch = what.stretch;
    TryUpdatesOf(what.device, setting, schedule, limits, trials);
  };
  if (what.quick) {
    for (const char* algorithm : {"sac", "td3", "ddpg", "drqv2"}) {
      make({algorithm, "", kSingle}, {40, 10, 5, 8}, kVectors);
    }
    make({"sac", "compact", kSingle}, {6, 2, 2, 2}, kPixels);
    make({"ppo", "", kSingle}, {3, 1, 1, 8}, kRollouts);
    return;
  }
  for (const char* algorithm : {"sac", "td3", "ddpg", "drqv2"}) {
    make({algorithm, "", kSingle}, {200, 40, 40, 16}, kVectors);
    for (const char* encoder : {"compact", "drq", "nature", "spatial_softmax"}) {
      make({algorithm, encoder, kSingle}, {200, 20, 5, 16}, kPixels);
    }
  }
  for (const char* encoder : {"", "compact", "drq", "nature", "spatial_softmax"}) {
    make({"ppo", encoder, kSingle}, {10, 1, 1, 16}, kRollouts);
  }
  // The CPU takes up to half a second for an update of these.
  make({"sac", "alexnet", kSingle}, {10, 2, 2, 16}, kDeep);
  make({"td3", "resnet18", kSingle}, {6, 2, 2, 16}, kDeep);
  // The CPU's engine needs a CPU with bf16.
  if (nn::ChoosePrecision("auto", /*pixels=*/true) == nn::Precision::kBf16) {
    make({"sac", "compact", nn::Precision::kBf16}, {200, 20, 5, 16}, kBf16);
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

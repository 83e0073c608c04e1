// SPDX-License-Identifier: Apache-2.0
// Compares an update with the oneDNN primitives that it runs, executed back to back: the rest is
// the cost of Shoal's own code. Compares the update with its convolutions alone, the least cost of
// the network, and the convolutions with the peak rate of a core in bf16, the limit of the machine.
#include <fmt/core.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/nn/parallel.h"
#include "common/nn/precision.h"
#include "learner/agent/algorithms.h"
#include "tests/benchmark/bf16_peak.h"
#include "tests/benchmark/noise_batch.h"
#include "tests/benchmark/paired_timing.h"
#include "tests/common/nn/primitive_trace.h"

namespace shoal::bench {
namespace {

constexpr double kPrimitivesTarget = 1 / 1.25;
constexpr double kCompactSeconds = 0.015;  // meant for an update of `compact`, batch 128
constexpr int kUpdates = 2;                // of a call: one of them moves the actor

// An agent, its batch, and the primitives of kUpdates updates.
struct Traced {
  Traced(const Config& config, const ObservationSpec& spec)
      : noise(config, spec),
        agent(learner::MakeAgent(config, spec, nn::ChoosePrecision("auto", spec.HasPixels()))) {
    Update();  // what happens once does not count
    trace.emplace([this] { Update(); });
  }
  void Update() {
    for (int i = 0; i < kUpdates; ++i) agent->Update(noise.batch);
  }

  NoiseBatch noise;
  const std::unique_ptr<learner::Agent> agent;
  std::optional<nn::PrimitiveTrace> trace;
};

// The one that a row asked for last: each is large.
class LatestTraced {
 public:
  Traced& Get(const std::string& name, const Config& config, const ObservationSpec& spec) {
    if (name != name_) {
      traced_.reset();
      traced_ = std::make_unique<Traced>(config, spec);
      name_ = name;
    }
    return *traced_;
  }

 private:
  std::string name_;
  std::unique_ptr<Traced> traced_;
};

constexpr const char* kItsPrimitives = "its primitives alone";
constexpr const char* kPeak = "bf16 peak of one core";

// "SAC update, ENCODER, batch B of (C, H, W), PRECISION".
std::string StageOf(const std::string& encoder, int batch) {
  return fmt::format("SAC update, {}, batch {} of (6, 84, 84), auto", encoder, batch);
}

std::string WhyNoPeak() { return HasBf16Peak() ? "" : "this CPU has no AVX-512 bf16"; }

Pairing PeakPairing() {
  constexpr double kOperations = 1e8;
  return {.stage = kPeak,
          .unit = "GFLOP/s",
          .against = "f32 multiply-adds of the same width",
          .units_per_call = 1e-9 * kOperations,
          .ours = [] { RunAtBf16Peak(kOperations); },
          .other = [] { RunAtF32Peak(kOperations); },
          .skipped = WhyNoPeak()};
}

// The convolutions, compared with the same number of operations at the peak rate.
Pairing ConvolutionsPairing(const std::string& stage, const std::function<Traced&()>& get) {
  return {.stage = "convolutions of a " + stage,
          .unit = "GFLOP/s",
          .against = kPeak,
          .ours = [get] { get().trace->Run(nn::PrimitiveTrace::Part::kConvolutions); },
          .other = [get] { RunAtBf16Peak(get().trace->ConvolutionOperations()); },
          .units = [get] { return 1e-9 * get().trace->ConvolutionOperations(); },
          .skipped = WhyNoPeak()};
}

}  // namespace

std::vector<Pairing> UpdatePairings() {
  if (nn::Threads() > 1) return {};  // replicas on threads: their primitives never run alone
  std::vector<Pairing> pairings{PeakPairing()};
  const auto latest = std::make_shared<LatestTraced>();
  for (const int batch : {128, 256}) {
    const std::string stage = fmt::format("MR.Q update, vectors alone, batch {}", batch);
    const auto get = [=]() -> Traced& {
      return latest->Get(stage, LatentModel(batch), VectorSpec());
    };
    pairings.push_back({.stage = stage,
                        .unit = "updates/s",
                        .against = kItsPrimitives,
                        .units_per_call = kUpdates,
                        .ours = [get] { get().Update(); },
                        .other = [get] { get().trace->Run(); }});
  }
  for (const std::string encoder : {"compact", "drq", "mrq", "nature", "spatial_softmax"}) {
    for (const int batch : {128, 256}) {
      const std::string stage = StageOf(encoder, batch);
      Config config;
      config.network.encoder = encoder;
      config.learner.batch = batch;
      const auto get = [=]() -> Traced& { return latest->Get(stage, config, PixelSpec()); };
      Pairing pairing{.stage = stage,
                      .unit = "updates/s",
                      .against = kItsPrimitives,
                      .units_per_call = kUpdates,
                      .target = kPrimitivesTarget,
                      .ours = [get] { get().Update(); },
                      .other = [get] { get().trace->Run(); }};
      pairings.push_back(pairing);
      pairing.against = "its convolutions alone";
      pairing.target = 0;  // a limit beside a peer's rate alone: tests/comparison/bench_peers.py
      pairing.other = [get] { get().trace->Run(nn::PrimitiveTrace::Part::kConvolutions); };
      pairings.push_back(pairing);
      pairings.push_back(ConvolutionsPairing(pairing.stage, get));
      if (encoder == "compact" && batch == 128) {
        pairing.against = fmt::format("its convolutions at the {}", kPeak);
        pairing.other = [get] { RunAtBf16Peak(get().trace->ConvolutionOperations()); };
        pairing.skipped = WhyNoPeak();
        pairings.push_back(pairing);
        pairing.skipped.clear();
        pairing.against = fmt::format("one in {:.0f} ms", 1e3 * kCompactSeconds);
        pairing.target = 1;
        pairing.other = {};
        pairing.other_rate = 1 / kCompactSeconds;
        pairings.push_back(pairing);
      }
    }
  }
  return pairings;
}

}  // namespace shoal::bench
